#pragma once

#include <vector>

#include "collision/exact/cpu_traversal.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The pairs that collide in each of kSampledStates random states within the joint limits, without
/// CollisionProblem::always_colliding, in ascending order. `traversal` must be that of `problem`. Usually two or three
/// states suffice: the search ends when no pair has collided in all states so far.
std::vector<BodyPair> collidingInSamples(const RobotModel& robot, const CollisionProblem& problem,
                                         const CpuTraversal& traversal);
}  // namespace gpu_planning_scene::core
