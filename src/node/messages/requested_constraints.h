#pragma once

#include <string>

#include "node/messages/messages.h"
#include "node/messages/other_frames.h"
#include "node/messages/requested_poses.h"
#include "scene/constraints_from_message.h"

namespace gpu_planning_scene::core
{
/// The frames and links that constraints of a request name, as the reader finds them. The arguments must outlive the
/// result.
ConstraintFrames constraintFrames(PoseReader& reader, const PlanningScene& scene);

/// Constraints of a request that hold along motions of a group. `state`: where frames that move with the robot are;
/// null if it is not known. Throws Error for a wrong message, and for a frame that the group moves: a link, what a link
/// carries, or one of the other frames that hangs on a link.
KinematicConstraints requestedPathConstraints(const Constraints& message, const PlanningScene& scene,
                                              const std::string& group, const double* state, const OtherFrames& others);
}  // namespace gpu_planning_scene::core
