#pragma once

#include <string>
#include <vector>

#include "node/messages/requested_states.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Adds warnings about a state of a request: an assumed base, values outside the group beyond their limits, and many
/// turns. `what`: "the start", begins the lines.
void addStateWarnings(const Snapshot& now, const std::string& group, const RequestedState& requested,
                      const std::string& what, std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
