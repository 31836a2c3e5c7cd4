#pragma once

#include <vector>

#include <visualization_msgs/Marker.h>

#include "node/markers/shown_plan.h"

namespace gpu_planning_scene::core
{
/// Markers of a plan's goal poses and goal constraints, in the planning frame, without goals that are joint values.
/// Namespaces:
/// - goals: a small sphere at each goal. It is green if the path ends there, red if no goal has a valid state, and grey
///   otherwise.
/// - goal_axes: the axes of each goal with an orientation, in red, green and blue.
/// - goal_regions: the region of each goal without an orientation, translucent.
/// - goal_reasons: the plan's message at the first red goal.
/// An orientation without a position is drawn at the origin of its link in the last state of the path, or in the start
/// without a path. At most 32 goals are drawn, and those at which the path ends.
std::vector<visualization_msgs::Marker> goalMarkers(const ShownPlan& plan);
}  // namespace gpu_planning_scene::core
