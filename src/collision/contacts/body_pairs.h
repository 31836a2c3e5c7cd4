#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// The checked pairs of instances of a problem, by their bodies. Immutable.
class BodyPairs
{
 public:
  explicit BodyPairs(const CollisionProblem& problem);

  /// Calls visit(instance pair) for each pair of two bodies, given in ascending order. The second instance is not a
  /// half-space.
  template <class Visit>
  void visit(const CollisionProblem& problem, const BodyPair& bodies, const Visit& visit) const
  {
    const auto self = self_pairs_.find(bodies);
    if (self != self_pairs_.end())
      for (const InstancePair& pair : self->second)
        visit(pair);
    // A world object may come before or after the body of the robot.
    for (const auto& [robot, object] : {bodies, BodyPair{bodies[1], bodies[0]}})
    {
      const auto first = robot_.find(robot);
      const auto second = world_.find(object);
      if (first == robot_.end() || second == world_.end())
        continue;
      for (const std::uint32_t i : first->second)
        for (const std::uint32_t k : second->second)
          if (problem.world_pairs[i * problem.world.size() + k] != 0)
            visit({i, static_cast<std::uint32_t>(problem.robot.size()) + k});
    }
  }

 private:
  using InstancesOfBody = std::map<std::int32_t, std::vector<std::uint32_t>>;

  std::map<BodyPair, std::vector<InstancePair>> self_pairs_;
  InstancesOfBody robot_;
  InstancesOfBody world_;
};
}  // namespace gpu_planning_scene::core
