#pragma once

#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Markers of a path for RViz, in the planning frame. The first marker deletes all earlier markers. Namespaces:
/// - ghosts: the bodies that the group moves, translucent, in states along the path at equal joint displacements. The
///   first is blue, the last is green. There are as many ghosts as `max_triangles` allows, from 2 (start and goal) to
///   6. If even two have more triangles, the largest meshes are drawn as boxes.
/// - path: for each link at the end of a chain of the group, a line along the link's path.
/// - waypoints: a point at each waypoint of these lines.
/// `waypoints`: rows of all variables.
visualization_msgs::MarkerArray pathMarkers(const PlanningScene& scene,
                                            const std::vector<std::vector<double>>& waypoints, const Group& group,
                                            std::size_t max_triangles);
}  // namespace gpu_planning_scene::core
