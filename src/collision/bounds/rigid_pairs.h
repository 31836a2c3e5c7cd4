#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "collision/exact/forest_cache.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// Pairs of bodies that no joint moves against each other: two on links that are fixed to each other, or an object and
/// one on a link that is fixed in the planning frame. What is found of a robot's own links is kept for the next scene.
class RigidPairs
{
 public:
  /// Takes such pairs out of `pairs` and returns them.
  static CheckedPairs take(const RobotModel& robot, const std::vector<RobotBody>& bodies, CheckedPairs& pairs);

  /// The bodies of a pair of those that the group moves that collides, if there is one: then every state does.
  std::optional<BodyPair> firstCollision(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                                         CheckedPairs fixed);

 private:
  std::unique_ptr<const CpuTraversal> traversalOf(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                                                  const CheckedPairs& pairs, ForestCache& forest);

  std::shared_ptr<const RobotModel> robot_;
  std::map<BodyPair, bool> links_collide_;  // of pairs of the robot's links that were asked for
  TessellationCache tessellations_;
  ForestCache forest_;  // of the other pairs
};
}  // namespace gpu_planning_scene::core
