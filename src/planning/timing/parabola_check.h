#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/state_checker.h"
#include "planning/timing/blended_path.h"

namespace gpu_planning_scene::core
{
/// Checks curves in bulk by a motion rule. Returns one byte per curve: 1 if it is valid. Under MotionRule::Bound, the
/// curve itself is proven free, and not a polyline near it. A curve that needs very many samples is not valid. When
/// `stop` returns true, curves without a verdict get 0.
std::vector<std::uint8_t> validParabolas(const RobotModel& robot, StateChecker& checker, const std::string& group,
                                         const MotionCheckerOptions& options, const std::vector<Phase>& parabolas,
                                         const std::function<bool()>& stop);
}  // namespace gpu_planning_scene::core
