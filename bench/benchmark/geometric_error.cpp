#include "benchmark/geometric_error.h"

#include <algorithm>

#include "collision/bounds/problem_maker.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kFarthest = 1.0;   // metres
constexpr double kNearest = 1e-12;  // metres
constexpr double kContract = 1e-9;  // metres: tolerance of the contract
constexpr int kHalvings = 12;

std::shared_ptr<const CpuForest> forestOf(const CollisionProblem& problem)
{
  return std::make_shared<const CpuForest>(problem, buildBinnedSah(problem.tessellations));
}

/// The problem restricted to the pairs of two bodies.
std::shared_ptr<const CollisionProblem> restrictedTo(const CollisionProblem& problem, const BodyPair& pair)
{
  const auto is_pair = [&](std::int32_t a, std::int32_t b) { return BodyPair{std::min(a, b), std::max(a, b)} == pair; };
  auto restricted = std::make_shared<CollisionProblem>(problem);
  auto& self = restricted->self_pairs;
  self.erase(
      std::remove_if(self.begin(), self.end(),
                     [&](const auto& p) { return !is_pair(problem.robot[p[0]].body, problem.robot[p[1]].body); }),
      self.end());
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
    for (std::size_t k = 0; k < problem.world.size(); ++k)
      if (!is_pair(problem.robot[i].body, problem.world[k].body))
        restricted->world_pairs[i * problem.world.size() + k] = 0;
  return restricted;
}

/// 26 unit vectors towards the faces, edges and corners of a cube.
std::vector<Vector3d> directions()
{
  std::vector<Vector3d> all;
  for (int i = 0; i < 27; ++i)
    if (const Eigen::Vector3i direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1); !direction.isZero())
      all.push_back(direction.cast<double>().normalized());
  return all;
}

/// Moves one body of a colliding pair.
class Separation
{
 public:
  Separation(const CollisionProblem& problem, const std::shared_ptr<const CpuForest>& forest, const BodyPair& pair,
             const std::vector<Isometry3d>& poses)
    : exact_(restrictedTo(problem, pair), forest), poses_(poses), shifted_(poses), link_(linkOf(problem, pair))
  {
  }

  bool apart(const Vector3d& shift)
  {
    shifted_[link_] = poses_[link_];
    shifted_[link_].pretranslate(shift);
    return !exact_.firstCollision(shifted_.data(), scratch_).has_value();
  }

 private:
  /// The link of a body of the pair. At least one of the two is a link or an attached object.
  static std::size_t linkOf(const CollisionProblem& problem, const BodyPair& pair)
  {
    const auto moved = std::find_if(problem.robot.begin(), problem.robot.end(),
                                    [&](const ShapeInstance& instance)
                                    { return instance.body == pair[0] || instance.body == pair[1]; });
    return static_cast<std::size_t>(moved->link);
  }

  ExactChecker exact_;
  ExactChecker::Scratch scratch_;
  const std::vector<Isometry3d>& poses_;
  std::vector<Isometry3d> shifted_;
  std::size_t link_;
};

/// Length of the shortest separating translation along one of the directions.
double depthOf(Separation& pair)
{
  double least = kFarthest;
  for (const Vector3d& direction : directions())
  {
    if (!pair.apart(least * direction))
      continue;
    // Doubles the length until the bodies are apart, then bisects.
    double touching = 0.0;
    double free = kNearest;
    while (free < least && !pair.apart(free * direction))
    {
      touching = free;
      free *= 2.0;
    }
    free = std::min(free, least);
    for (int i = 0; i < kHalvings; ++i)
    {
      const double middle = 0.5 * (touching + free);
      (pair.apart(middle * direction) ? free : touching) = middle;
    }
    least = free;
  }
  return least;
}
}  // namespace

GeometricError::GeometricError(const PlanningScene& scene)
  : robot_(scene.robot),
    problem_(std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr))),
    forest_(forestOf(*problem_)),
    exact_(problem_, forest_),
    fcl_(problem_)
{
}

std::vector<Isometry3d> GeometricError::posesOf(const double* state) const
{
  std::vector<Isometry3d> poses(robot_->links().size());
  robot_->linkPoses(state, poses.data());
  return poses;
}

bool GeometricError::isOpen(const double* state, bool valid)
{
  const std::vector<Isometry3d> poses = posesOf(state);
  if (valid)
  {
    fcl_.setState(poses.data());
    return fcl_.clearance(2.0 * kContract) <= kContract;
  }
  for (const auto& pair : exact_.allCollisions(poses.data(), scratch_))
  {
    Separation separation(*problem_, forest_, pair, poses);
    const std::vector<Vector3d> all = directions();
    if (std::none_of(all.begin(), all.end(),
                     [&](const Vector3d& direction) { return separation.apart(kContract * direction); }))
      return false;
  }
  return true;
}

double GeometricError::clearance(const double* state)
{
  fcl_.setState(posesOf(state).data());
  return std::max(kNearest, fcl_.clearance(kFarthest));
}

double GeometricError::depth(const double* state)
{
  const std::vector<Isometry3d> poses = posesOf(state);
  double deepest = kNearest;
  for (const auto& pair : exact_.allCollisions(poses.data(), scratch_))
  {
    Separation separation(*problem_, forest_, pair, poses);
    deepest = std::max(deepest, depthOf(separation));
  }
  return deepest;
}
}  // namespace gpu_planning_scene::core::benchmark
