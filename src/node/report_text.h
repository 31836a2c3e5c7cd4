#pragma once

#include "node/messages.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// Writes the report of `answer`, which must have one, into the response.
void fillReport(const CheckAnswer& answer, GetReport::Response& response);
}  // namespace gpu_planning_scene::core
