#pragma once

#include <set>

#include <moveit/collision_detection/collision_common.h>
#include <moveit/robot_state/robot_state.h>

#include "moveit/pairs/pair_filter.h"
#include "moveit/shapes/robot_geometry.h"
#include "moveit/shapes/world_geometry.h"

namespace gpu_planning_scene::detector
{
/// Checks the motion that MoveIt interpolates between two states against the world. The motion is free only if a bound
/// of the robot's motion proves it, also between the samples. Everything without a proof counts as a collision, for
/// example a motion that passes an object within 0.1 mm, or a pair with a decider that comes into contact. If the two
/// states carry different objects of the same names, those of each state must be free over the whole motion.
/// Contacts are those at the first sample that collides; their percent_interpolation is the sample's place, 0 to 1. If
/// no sample collides, the only contact names a pair without proof; it has no depth.
void checkMotion(const collision_detection::CollisionRequest& request, collision_detection::CollisionResult& result,
                 const moveit::core::RobotState& from, const moveit::core::RobotState& to, const RobotGeometry& robot,
                 const WorldGeometry& world, const PairFilter& filter,
                 const std::set<const moveit::core::LinkModel*>* active);
}  // namespace gpu_planning_scene::detector
