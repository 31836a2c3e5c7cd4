#pragma once

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene
{
/// What no checker can use, as scenes may come from a program as well as from a file: throws Error for two objects of
/// one name, a pose or shape that is not valid, a negative padding, a half-space in a link or a carried object, or an
/// attached object whose links the robot does not have. (The robot's shapes were checked when it was loaded.)
void validateScene(const PlanningScene& scene);

bool hasHalfSpace(const std::vector<PlacedShape>& shapes);
}  // namespace gpu_planning_scene
