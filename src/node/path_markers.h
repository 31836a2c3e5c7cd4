#pragma once

#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A path as RViz draws it, in the planning frame: the ways of the links at the ends of the group's chains, as lines,
/// and a point at each waypoint. The first marker deletes those of before. `waypoints`: rows of all variables.
visualization_msgs::MarkerArray pathMarkers(const PlanningScene& scene,
                                            const std::vector<std::vector<double>>& waypoints, const Group& group);
}  // namespace gpu_planning_scene::core
