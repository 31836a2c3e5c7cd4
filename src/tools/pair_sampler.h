#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "collision/exact/forest_cache.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/allowed_collision_matrix.h"
#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Link indices in ascending order, and the number of states in which the two links collide.
using HitCounts = std::map<BodyPair, std::size_t>;

/// Counts for each pair of links in how many states it collides. A StateChecker reports only one pair per state, so
/// this class uses the exact checker's traversal, which finds all pairs.
class PairSampler
{
 public:
  /// Leaves out the pairs that `decided` allows. `trees` keeps the trees of the links for the next sampler.
  PairSampler(std::shared_ptr<const RobotModel> robot, const AllowedCollisionMatrix& decided, ForestCache& trees);

  /// Adds the collisions in `count` states to `counts`.
  void add(const std::vector<double>& states, std::size_t count, HitCounts& counts) const;

  const CollisionProblem& problem() const { return *problem_; }

 private:
  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const CollisionProblem> problem_;
  std::unique_ptr<const ExactChecker> exact_;
};
}  // namespace gpu_planning_scene::core
