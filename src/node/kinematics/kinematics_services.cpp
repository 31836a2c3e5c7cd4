#include "node/kinematics/kinematics_services.h"

#include <utility>

#include "gpu_planning_scene/error.h"
#include "node/parameters/parameter_values.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
KinematicsOptions kinematicsOptionsFromParameters(const ros::NodeHandle& own)
{
  constexpr std::size_t kMost = std::size_t{1} << 31;
  KinematicsOptions options;
  options.max_attempts = countParameter(own, "limits/ik_attempts", options.max_attempts, 1, kMost);
  options.max_solutions = countParameter(own, "limits/ik_solutions", options.max_solutions, 1, kMost);
  options.max_waiting = countParameter(own, "limits/waiting_ik", options.max_waiting, 0, 1000);
  return options;
}

KinematicsServices::KinematicsServices(const SceneStore& store, OtherFrames others, MakeChecker make_checker,
                                       InspectorOf inspector_of, const MemoryGuard& memory,
                                       const KinematicsOptions& options)
  : store_(store),
    others_(std::move(others)),
    inspector_of_(std::move(inspector_of)),
    memory_(memory),
    options_(options),
    admission_(kSearchingRequests, options.max_waiting),
    checkers_(std::move(make_checker))
{
}

void KinematicsServices::stop()
{
  stopping_ = true;
  admission_.stop();
}

void KinematicsServices::refuseIfStopping() const
{
  if (stopping_)
    throw ShuttingDown();
}
}  // namespace gpu_planning_scene::core
