#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "collision/exact/forest_cache.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// Decides rigid pairs once per scene. No joint moves the two bodies of a rigid pair relative to each other: their
/// links are fixed to each other, or one body is an object and the other one's link is fixed in the planning frame.
/// Results for a robot's own links are kept for the next scene.
class RigidPairs
{
 public:
  /// Moves the rigid pairs from `pairs` to the result.
  static CheckedPairs take(const RobotModel& robot, const std::vector<RobotBody>& bodies, CheckedPairs& pairs);

  /// The colliding pairs among the pairs that the group moves, each once, in ascending order. They collide in every
  /// state.
  std::vector<BodyPair> collisions(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                                   CheckedPairs rigid);

 private:
  std::unique_ptr<const ExactChecker> exactCheckerOf(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                                                     const CheckedPairs& pairs, ForestCache& forest);

  std::shared_ptr<const RobotModel> robot_;
  std::map<BodyPair, bool> links_collide_;  // results for pairs of the robot's links, as far as they have been checked
  TessellationCache tessellations_;
  ForestCache forest_;  // trees of the other pairs
};
}  // namespace gpu_planning_scene::core
