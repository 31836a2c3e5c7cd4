#pragma once

#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Markers of a path for RViz, in the planning frame. The first marker deletes all earlier markers. Namespaces:
/// - ghosts: the bodies that the path moves, translucent, in states along the path at equal joint displacements. The
///   start is blue and the goal is green; up to two fainter ghosts show the robot between them. There are as many
///   ghosts as `max_triangles` allows, at least start and goal. If even these have more triangles, the largest meshes
///   are drawn as boxes.
/// - path: for each end of the group, for example a hand, a line along its path.
/// - waypoints: a point at each waypoint of these lines.
/// - labels: "start" and "goal" near the ends of the first line, outside the boxes around the first and last ghost.
/// `waypoints`: rows of all variables.
visualization_msgs::MarkerArray pathMarkers(const PlanningScene& scene,
                                            const std::vector<std::vector<double>>& waypoints, const Group& group,
                                            std::size_t max_triangles);
}  // namespace gpu_planning_scene::core
