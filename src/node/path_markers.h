#pragma once

#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Markers of a path for RViz, in the planning frame. For each link at the end of a chain of the group, a line shows
/// the link's path, with a point at each waypoint. The first marker deletes all earlier markers. `waypoints`: rows of
/// all variables.
visualization_msgs::MarkerArray pathMarkers(const PlanningScene& scene,
                                            const std::vector<std::vector<double>>& waypoints, const Group& group);
}  // namespace gpu_planning_scene::core
