#pragma once

#include "gpu_planning_scene/scene_change.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
// Two nodes give the same answers only if all numbers of their scenes are equal to the last bit. The conversion to a
// message and back changes some last bits: a rotation becomes a quaternion, and a plane is normalised. The fields
// exact_places and exact_values keep these numbers.
//
// The place of a number is its position in this order: values of variables (by name), fixed frames (by name: the pose),
// attached objects, objects, octomap. Each object has its pose, the poses and the numbers of its shapes, its new shape
// poses and its subframes (by name). A pose has 12 numbers: the columns of its matrix without the last row.

/// In PlanningSceneComponents::components: the fields for followers are wanted.
constexpr std::uint32_t kForFollowers = 1024;
/// All components, as followers get them.
constexpr std::uint32_t kWholeForFollowers = 2 * kForFollowers - 1;

/// Fills the two fields. `message`: made of `change` by messageOf().
void keepExactNumbers(const SceneChange& change, const RobotModel& robot, PlanningSceneMessage& message);

/// Sets the numbers that the two fields keep. `change`: made of `message` by changeFrom(). Throws Error for a place
/// that `change` does not have.
void takeExactNumbers(const PlanningSceneMessage& message, SceneChange& change);
}  // namespace gpu_planning_scene::core
