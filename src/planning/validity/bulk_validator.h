#pragma once

#include <ompl/base/SpaceInformation.h>

#include "gpu_planning_scene/planning/motion_validator.h"

namespace gpu_planning_scene::core
{
/// The motion validator of the space information. Throws ompl::Exception in the name of `user` if it is not a
/// MotionValidator of this package, which checks motions in bulk.
const MotionValidator& bulkValidatorOf(const ompl::base::SpaceInformation& information, const char* user);
}  // namespace gpu_planning_scene::core
