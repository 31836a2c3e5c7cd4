#pragma once

#include <string>

#include <ompl/base/SpaceInformation.h>

#include "gpu_planning_scene/planning/motion_validator.h"

namespace gpu_planning_scene::core
{
/// What checks motions in bulk. Throws ompl::Exception in the name of `user` if the space information has another
/// motion validator.
const MotionValidator& bulkValidatorOf(const ompl::base::SpaceInformation& information, const std::string& user);
}  // namespace gpu_planning_scene::core
