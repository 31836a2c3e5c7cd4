#pragma once

#include "node/messages.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// `answer` has a report.
void fillReport(const CheckAnswer& answer, GetReport::Response& response);
}  // namespace gpu_planning_scene::core
