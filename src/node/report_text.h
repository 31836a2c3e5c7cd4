#pragma once

#include "gpu_planning_scene/messages.h"
#include "service/check_server.h"

namespace gpu_planning_scene
{
/// `answer` has a report.
void fillReport(const CheckAnswer& answer, GetReport::Response& response);
}  // namespace gpu_planning_scene
