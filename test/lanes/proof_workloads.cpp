#include <array>
#include <cmath>
#include <random>

#include "collision/bounds/problem_maker.h"
#include "collision/cpu/lanes/lane_scene.h"
#include "collision/exact/forest_cache.h"
#include "collision/gpu/gpu_checker.h"
#include "collision/gpu/sliding_balls.h"
#include "gpu/program.h"
#include "lanes/workloads.h"
#include "shader_constants.h"

// Tasks for the proofs of the device: states near contact that balls and joint tables decide, and the centres
// of two balls.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kStates = 32;

/// Two small boxes far from the base, each at the end of an arm that turns, so that positions and rotations have large
/// rounding errors compared with the boxes; among a box, a cylinder and a stone.
std::shared_ptr<const PlanningScene> turningBoxes()
{
  const auto link = [](const std::string& name, const std::string& size)
  { return "<link name='" + name + "'><collision><geometry><box size='" + size + "'/></geometry></collision></link>"; };
  const auto joint = [](const std::string& type, const std::string& parent, const std::string& child,
                        const std::string& place, const std::string& axis)
  {
    return "<joint name='to_" + child + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child +
           "'/><origin xyz='" + place + "' rpy='0.3 0.2 0.1'/><axis xyz='" + axis +
           "'/><limit lower='-0.02' upper='0.02' effort='1' velocity='1'/></joint>";
  };
  const auto robot = RobotModel::fromXml(
      "<robot name='turning_boxes'>" + link("base", "0.1 0.1 0.1") + "<link name='first'/><link name='second'/>" +
          link("left", "0.02 0.03 0.04") + link("right", "0.05 0.01 0.02") +
          joint("revolute", "base", "first", "0 0 0.1", "0 0.6 0.8") +
          joint("revolute", "first", "left", "2 0 0", "0.8 0 0.6") +
          joint("revolute", "base", "second", "0 0.02 0.1", "0.6 0 0.8") +
          joint("prismatic", "second", "right", "2 0.01 0.01", "0 0.6 0.8") + "</robot>",
      "", {});
  auto scene = std::make_shared<PlanningScene>(robot);
  std::vector<Eigen::Isometry3d> links(robot->links().size());
  robot->linkPoses(std::vector<double>(robot->variables().size()).data(), links.data());
  const auto add = [&](const std::string& id, const Shape& shape, const Eigen::Vector3d& from_left)
  {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
    pose.translation() = links.back().translation() + from_left;
    scene->objects.push_back({id, pose, {{shape, Eigen::Isometry3d::Identity()}}, 0.0});
  };
  add("box", Box{{0.03, 0.02, 0.05}}, {0.06, 0.0, 0.0});
  add("can", Cylinder{0.02, 0.04}, {0.0, 0.07, 0.0});
  add("stone", tessellate(Box{{0.03, 0.03, 0.02}}).mesh, {0.0, 0.0, 0.06});
  return scene;
}

/// A scene with its proofs, made now or loaded from the user's cache. `limit`: of the values of all joints, from the
/// negative to the positive.
struct Proven
{
  Proven(std::shared_ptr<const PlanningScene> of, double largest, bool exact_covers)
    : scene(std::move(of)),
      limit(largest),
      problem(std::make_shared<const CollisionProblem>(makeProblem(*scene, "", nullptr))),
      exact(forest.exactCheckerOf(problem))
  {
    RobotProver prover;
    prover.prove(
        *scene->robot, *problem, forest.forest(), ProofCache::ofUser(),
        [this](RobotProofs made) { proofs = std::move(made); }, [] { return false; });
    if (exact_covers)
      proofs.covers = exactCovers(*problem, *scene->robot);
  }

  std::shared_ptr<const PlanningScene> scene;
  double limit;
  std::shared_ptr<const CollisionProblem> problem;
  ForestCache forest;
  std::unique_ptr<const ExactChecker> exact;
  RobotProofs proofs;

  bool isFree(const std::vector<double>& state) const
  {
    std::vector<Eigen::Isometry3d> links(scene->robot->links().size());
    scene->robot->linkPoses(state.data(), links.data());
    ExactChecker::Scratch scratch;
    return !exact->firstCollision(links.data(), scratch);
  }
};

std::vector<double> between(const std::vector<double>& from, const std::vector<double>& to, double share)
{
  std::vector<double> state;
  for (std::size_t i = 0; i < from.size(); ++i)
    state.push_back(from[i] + share * (to[i] - from[i]));
  return state;
}

/// Checks states near contact, and returns a line for each wrong verdict.
std::vector<std::string> checkNearContact(const Proven& proven, const std::string& shaders, std::uint64_t seed)
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const std::size_t width = proven.scene->robot->variables().size();
  const auto random = [&]
  {
    std::vector<double> state(width);
    for (double& value : state)
      value = proven.limit * uniform(generator);
    return state;
  };
  std::vector<double> states;
  while (states.size() < kStates * width)
  {
    const std::vector<double> free = random();
    const std::vector<double> colliding = random();
    if (!proven.isFree(free) || proven.isFree(colliding))
      continue;
    double low = 0.0;
    double high = 1.0;
    for (int step = 0; step < 50; ++step)
    {
      const double middle = 0.5 * (low + high);
      (proven.isFree(between(free, colliding, middle)) ? low : high) = middle;
    }
    // From 1e-9 to 1e-3 of the motion before or behind the contact.
    const double beside = std::copysign(std::pow(10.0, -6.0 + 3.0 * uniform(generator)), uniform(generator));
    const std::vector<double> state = between(free, colliding, low + beside);
    states.insert(states.end(), state.begin(), state.end());
  }
  BatchCheckerOptions options;
  options.shader_folder = shaders;
  options.max_batch = kStates;
  GpuChecker checker(options);
  checker.setProblem(proven.problem, proven.scene->robot);
  checker.useProofs(std::make_shared<const LaneScene>(*proven.scene->robot, *proven.problem, *proven.forest.forest(),
                                                      std::make_shared<const RobotProofs>(proven.proofs),
                                                      lanes::kDeviceRounding));
  BatchResult result;
  checker.check(states.data(), kStates, result);
  std::vector<std::string> wrong;
  if (!checker.fault().empty())
    wrong.push_back("the test of the arithmetic fails: " + checker.fault());
  for (std::size_t i = 0; i < kStates; ++i)
  {
    const auto first = states.begin() + static_cast<std::ptrdiff_t>(i * width);
    if ((result.valid[i] != 0) != proven.isFree({first, first + static_cast<std::ptrdiff_t>(width)}))
      wrong.push_back("state " + std::to_string(i) + " of " + std::to_string(kStates) + " is called " +
                      (result.valid[i] != 0 ? "free" : "a collision"));
  }
  return wrong;
}
}  // namespace

std::vector<std::string> checkProofs(const std::string& shaders, std::uint64_t seed)
{
  static const Proven proven(slidingBalls(), kSlide, true);
  return checkNearContact(proven, shaders, seed);
}

std::vector<std::string> checkTurningBoxes(const std::string& shaders, std::uint64_t seed)
{
  static const Proven proven(turningBoxes(), 0.02, false);
  return checkNearContact(proven, shaders, seed);
}

std::vector<std::string> checkBalls(const std::string& shaders, std::uint64_t seed)
{
  constexpr std::size_t kPairs = 256;
  constexpr std::size_t kTexels = 2;  // two centres, the reach beside the first one
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Eigen::Vector3d(uniform(generator), uniform(generator), uniform(generator)); };
  const auto texel = [](const Eigen::Vector3f& v, float w = 0.0F) {
    return std::array<float, 4>{v.x(), v.y(), v.z(), w};
  };
  std::vector<std::array<float, 4>> input;
  for (std::size_t i = 0; i < kPairs; ++i)
  {
    // The distance is 1e-4 to 1 of the distance from the origin. The reach is 1e-8 to 1e-1 of itself away from it.
    const Eigen::Vector3d place = vector();
    const Eigen::Vector3d between = std::pow(10.0, 2.0 * uniform(generator) - 2.0) * vector();
    const double share = std::copysign(std::pow(10.0, 3.5 * uniform(generator) - 4.5), uniform(generator));
    const Eigen::Vector3f a = place.cast<float>();
    const Eigen::Vector3f b = (place + between).cast<float>();
    const auto reach = static_cast<float>((1.0 + share) * between.norm());
    input.push_back(texel(a, reach));
    input.push_back(texel(b));
  }
  const Program program = Program::fromText(shaders, "balls", R"(// One invocation per pair of centres.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "common/comparisons.glsl"
#include "geometry/pose.glsl"
#include "proofs/records.glsl"
layout(std430, binding = 0) readonly buffer Pairs { vec4 pairs[]; };
layout(std430, binding = 1) writeonly buffer Results { uint results[]; };
void main()
{
  const uint i = invocationIndex();
  const vec4 a = pairs[2u * i];  // kTexels
  const vec3 between = vectorBetween(a.xyz, pairs[2u * i + 1u].xyz);
  const float squared = dot(between, between);
  // The part of lanes::kDeviceRounding.distance that remains after all positions are exact.
  const float error = 16.0 * UNIT_ROUNDOFF * a.w;
  results[i] = (isBeyond(squared, a.w + error) ? 1u : 0u) + (isWithin(squared, a.w - error) ? 2u : 0u);
}
)");
  Buffer pairs(input.size() * sizeof(input[0]));
  pairs.write(input);
  pairs.bindStorage(0);
  Buffer results(kPairs * sizeof(std::uint32_t));
  results.bindStorage(1);
  program.dispatch(kPairs / GROUP_SIZE);
  std::vector<std::uint32_t> found(kPairs);
  results.read(found.data(), kPairs * sizeof(std::uint32_t));
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < kPairs; ++i)
  {
    const auto point = [&](std::size_t k)
    { return Eigen::Map<const Eigen::Vector3f>(input[kTexels * i + k].data()).cast<double>().eval(); };
    const double distance = (point(1) - point(0)).norm();
    const auto reach = static_cast<double>(input[kTexels * i][3]);
    if (((found[i] & 1U) != 0 && !(distance > reach)) || ((found[i] & 2U) != 0 && !(distance < reach)))
      wrong.push_back("pair " + std::to_string(i) + ", at a distance of " + std::to_string(distance / reach) +
                      " times the reach: " + std::to_string(found[i]));
  }
  return wrong;
}
}  // namespace gpu_planning_scene::core
