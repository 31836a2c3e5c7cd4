#include <cmath>
#include <random>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/forest_cache.h"
#include "collision/gpu/gpu_checker.h"
#include "collision/gpu/sliding_balls.h"
#include "lanes/workloads.h"

// Balls and joint tables decide states near contact.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kStates = 32;

/// The scene with its proofs, made once.
struct Proven
{
  Proven()
  {
    RobotProver prover;
    prover.prove(
        *scene->robot, *problem, forest.forest(), ProofCache(), [this](RobotProofs made) { proofs = std::move(made); },
        [] { return false; });
    proofs.covers = exactCovers(*problem, *scene->robot);
  }

  std::shared_ptr<const PlanningScene> scene = slidingBalls();
  std::shared_ptr<const CollisionProblem> problem =
      std::make_shared<const CollisionProblem>(makeProblem(*scene, "", nullptr));
  ForestCache forest;
  std::unique_ptr<const CpuTraversal> exact = forest.traversalOf(problem);
  RobotProofs proofs;

  bool isFree(const std::vector<double>& state) const
  {
    std::vector<Eigen::Isometry3d> links(scene->robot->links().size());
    scene->robot->linkPoses(state.data(), links.data());
    CpuTraversal::Scratch scratch;
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
}  // namespace

std::vector<std::string> checkProofs(const std::string& shaders, std::uint64_t seed)
{
  static const Proven proven;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const std::size_t width = proven.scene->robot->variables().size();
  const auto random = [&]
  {
    std::vector<double> state(width);
    for (double& value : state)
      value = kSlide * uniform(generator);
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
  checker.useProofs(std::make_shared<const RobotProofs>(proven.proofs));
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
}  // namespace gpu_planning_scene::core
