#pragma once

#include "gpu_planning_scene/messages.h"

#include "gpu_planning_scene/state_checker.h"
#include "tools/full_states.h"

namespace gpu_planning_scene
{
/// Answers a request of the service `check_states`. `current` gives the variables that the request does not name.
/// Throws nothing: what is wrong with the request is said in the response.
CheckStates::Response answerCheckStates(const CheckStates::Request& request, const PlanningScene& scene,
                                        const PartialState& current, StateChecker& checker);
}  // namespace gpu_planning_scene
