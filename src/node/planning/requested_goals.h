#pragma once

#include <cstddef>

#include "gpu_planning_scene/planning/plan_motion.h"
#include "node/messages/messages.h"
#include "node/messages/other_frames.h"

namespace gpu_planning_scene::core
{
/// Whether a request has goals other than joint values.
bool hasGoalRegions(const PlanMotion::Request& request);

/// Adds the goal poses, the goal constraints and the path constraints of a request to its query, which has the group
/// and the start. `others`: the frames that the scene does not have. Throws Error for a wrong request.
void addRegions(const PlanMotion::Request& request, const PlanningScene& scene, const OtherFrames& others,
                std::size_t max_goals, PlanningQuery& query);
}  // namespace gpu_planning_scene::core
