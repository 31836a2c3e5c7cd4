#include "planning/validity/bulk_validator.h"

#include <ompl/util/Exception.h>

namespace gpu_planning_scene::core
{
const MotionValidator& bulkValidatorOf(const ompl::base::SpaceInformation& information, const char* user)
{
  const auto* validator = dynamic_cast<const MotionValidator*>(information.getMotionValidator().get());
  if (!validator)
    throw ompl::Exception(user,
                          "the motion validator of the space information does not check motions in bulk; set a "
                          "gpu_planning_scene::core::MotionValidator");
  return *validator;
}
}  // namespace gpu_planning_scene::core
