#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

// Steps of attaching and detaching that PlanningScene and SceneChanger share.
namespace gpu_planning_scene::core
{
/// Throws Error for the id of the octomap, which links cannot carry.
void requireNotOctomap(const std::string& id);

/// Throws Error if the object has a half-space.
void requireAttachable(const WorldObject& object);

/// The object of the world attached to the link. It stays where it is in `state`. Throws Error if the link's pose in
/// `state` is unknown or not finite.
AttachedObject attachedFromWorld(const RobotModel& robot, const WorldObject& object, int link, const double* state);

/// The attached object returned to the world. It stays where it is in `state`. Throws Error if the link's pose in
/// `state` is unknown or not finite.
WorldObject detachedToWorld(const RobotModel& robot, AttachedObject attached, const double* state);

/// Adds the links to the touch links of the object, each only once. An unknown link is left out with a warning, or is
/// an Error if `warnings` is null.
void addTouchLinks(const RobotModel& robot, const std::vector<std::string>& names, AttachedObject& attached,
                   std::vector<std::string>* warnings);
}  // namespace gpu_planning_scene::core
