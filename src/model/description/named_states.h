#pragma once

#include <set>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "model/description/srdf_reader.h"

namespace gpu_planning_scene::core
{
/// Finds the variables of the SRDF's named states. A state of an unknown group, and a joint that is unknown or has a
/// wrong value, give a warning and are left out. Joints without variables (fixed and mimic joints, `ignored_joints`)
/// are left out without a warning.
std::vector<NamedState> resolveNamedStates(const std::vector<SrdfNamedState>& states, const RobotModel& robot,
                                           const std::set<std::string>& ignored_joints,
                                           std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
