// Tasks for the tests of boxes and spheres that lie far from the origin and near each other.

#include <cmath>
#include <random>
#include <sstream>

#include "collision/exact/exact_checker.h"
#include "collision/gpu/gpu_checker.h"
#include "collision/trees/binned_sah.h"
#include "gpu/program.h"
#include "lanes/workloads.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Texel = std::array<float, 4>;

constexpr std::size_t kCases = 256;
constexpr std::size_t kStates = 64;

class Random
{
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  Vector3d vector() { return {uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)}; }
  Eigen::Quaterniond rotation()
  {
    std::normal_distribution<double> normal;
    return Eigen::Quaterniond(normal(generator_), normal(generator_), normal(generator_), normal(generator_))
        .normalized();
  }

 private:
  std::mt19937_64 generator_;
};

/// With g++ 12 -O3, a plain conversion of two neighbours to float and back does nothing.
float roundedNumber(double x)
{
  const volatile auto nearest = static_cast<float>(x);
  return nearest;
}

Texel texel(const Vector3d& v)
{
  return {roundedNumber(v.x()), roundedNumber(v.y()), roundedNumber(v.z()), 0.0F};
}

Vector3d exactly(const Texel& t)
{
  return {t[0], t[1], t[2]};
}

void bindTexels(TexelBuffer& buffer, const std::vector<Texel>& texels, std::uint32_t unit)
{
  buffer.reserve(texels.size() * TexelBuffer::kTexelBytes);
  buffer.buffer().write(texels);
  buffer.bindTexture(unit);
}
}  // namespace

/// Pairs of a corner and the centre of its box, 1 to 1e5 times their distance from the origin. The corner is rotated
/// into the frame of the box, as when a box is fitted. Both points, as boxes without size, are compared with a distance
/// that is less than theirs, as a traversal with a required distance does.
std::vector<std::string> checkBoxes(const std::string& shaders, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Texel> corners;     // in the layout of problem/triangles.glsl
  std::vector<Texel> root_pairs;  // in the layout of traversal/root_pairs.glsl
  std::vector<Texel> values;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    const Vector3d place = std::pow(10.0, random.uniform(0.0, 5.0)) * random.vector();
    const Texel origin = texel(place);
    const Texel corner = texel(place + random.vector());
    corners.insert(corners.end(), TRIANGLE_TEXELS, corner);
    root_pairs.resize(root_pairs.size() + ROOT_PAIR_TEXELS - 1);
    const double distance = (exactly(corner) - exactly(origin)).norm();
    root_pairs.push_back({static_cast<float>(distance * (1.0 - 1e-6)), 0.0F, 0.0F, 0.0F});
    const Eigen::Quaterniond q = random.rotation();
    values.push_back(origin);
    values.push_back(
        {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()), static_cast<float>(q.w())});
  }
  const Program program = Program::fromText(shaders, "boxes", R"(// One invocation per corner and centre of a box.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "problem/triangles.glsl"
#include "geometry/error_bounds.glsl"
#include "traversal/bounding_volume_overlap.glsl"
#include "traversal/close_enough.glsl"
#include "tree_build/fit_output.glsl"
#include "tree_build/fit.glsl"
layout(std430, binding = BINDING_C) readonly buffer Values { vec4 values[]; };
layout(std430, binding = BINDING_D) writeonly buffer Results { vec4 results[]; };
void main()
{
  const uint i = invocationIndex();
  const vec3 origin = values[2u * i].xyz;
  vec3 corners[3];
  fetchAround(i, origin, corners);
  const vec3 along = corners[0] * rotationOf(values[2u * i + 1u]);
  fetchTriangle(i, corners);
  const OrientedNode a = OrientedNode(Box(origin, vec3(0.0)), mat3(1.0), 0u, 1u);
  const OrientedNode b = OrientedNode(Box(corners[0], vec3(0.0)), mat3(1.0), 0u, 1u);
  const RootPair pair = RootPair(Pose(mat3(1.0), vec3(0.0)), 0u, 0u, 0.0, 0.0);
  results[i] = vec4(along, isCloseEnough(i, pair, a, b) ? 1.0 : 0.0);
}
)");
  TexelBuffer corner_texels;
  TexelBuffer root_pair_texels;
  bindTexels(corner_texels, corners, UNIT_TRIANGLES);
  bindTexels(root_pair_texels, root_pairs, UNIT_ROOT_PAIRS);
  Buffer input(values.size() * sizeof(Texel));
  input.write(values);
  Buffer output(kCases * sizeof(Texel));
  input.bindStorage(BINDING_C);
  output.bindStorage(BINDING_D);
  program.dispatch(groupsFor(kCases));
  std::vector<Texel> results(kCases);
  output.read(results.data(), kCases * sizeof(Texel));
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < kCases; ++i)
  {
    const Texel& q = values[2 * i + 1];
    const Vector3d between = exactly(corners[TRIANGLE_TEXELS * i]) - exactly(values[2 * i]);
    const Vector3d exact = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().conjugate() * between;
    const double error = (exactly(results[i]) - exact).norm();
    // The difference, and its rotation.
    const double bound = UNIT_ROUNDOFF * (1.0 + 25.0 * std::sqrt(3.0) + 3.0) * between.norm();
    std::ostringstream line;
    if (!(error <= bound))
      line << "a corner around the centre of its box is off by " << error << ", the bound is " << bound << ". ";
    if (results[i][3] != 0.0F)
      line << "boxes at a distance of " << between.norm() << " m are called close enough";
    if (!line.str().empty())
      wrong.push_back(line.str());
  }
  return wrong;
}

/// Two cubes of 0.1 m, 0.1 km to 3 km from the origin. A joint moves one of them through the other one.
std::vector<std::string> checkFarLinks(const std::string& shaders, std::uint64_t seed)
{
  Random random(seed);
  const Vector3d place = std::pow(10.0, random.uniform(2.0, 3.5)) * random.vector();
  std::ostringstream xml;
  xml << R"(<robot name="far_links"><link name="base"/><link name="first"/><link name="second"/>
      <joint name="fixed" type="fixed"><parent link="base"/><child link="first"/><origin xyz=")"
      << place.x() << " " << place.y() << " " << place.z() << R"("/></joint>
      <joint name="slide" type="prismatic"><parent link="first"/><child link="second"/><axis xyz="0 0 1"/>
        <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>)";
  const auto robot = RobotModel::fromXml(xml.str(), "", {});
  const auto problem = std::make_shared<CollisionProblem>();
  const Shape cube = tessellate(Box{{0.1, 0.1, 0.1}}).mesh;
  problem->tessellations.push_back(tessellate(cube));
  problem->shapes.insert(problem->shapes.end(), 1, cube);
  problem->robot = {{0, 1, 1, Isometry3d::Identity()}, {0, 2, 2, Isometry3d(random.rotation())}};
  problem->self_pairs = {{0, 1}};
  BatchCheckerOptions options;
  options.shader_folder = shaders;
  options.max_batch = kStates;
  GpuChecker checker(options);
  checker.setProblem(problem, robot);

  std::vector<double> states;
  for (std::size_t i = 0; i < kStates; ++i)
    states.push_back(random.uniform(-0.2, 0.2));
  BatchResult result;
  checker.check(states.data(), kStates, result);
  const ExactChecker exact(problem, std::make_shared<const Forest>(buildBinnedSah(problem->tessellations)));
  ExactChecker::Scratch scratch;
  std::vector<std::string> wrong;
  Isometry3d links[3];
  for (std::size_t i = 0; i < kStates; ++i)
  {
    robot->linkPoses(&states[i], links);
    if ((result.valid[i] != 0) == !exact.firstCollision(links, scratch))
      continue;
    wrong.push_back("cubes " + std::to_string(states[i]) + " m from each other are called " +
                    (result.valid[i] != 0 ? "free" : "a collision"));
  }
  return wrong;
}
}  // namespace gpu_planning_scene::core
