#include "node/checks/watched_checkers.h"

#include <ros/console.h>

namespace gpu_planning_scene::core
{
CheckServer::MakeChecker makeWatchedCheckers(const BatchCheckerOptions& options, const ResilientOptions& resilience,
                                             const OpenDevice& open_device, Diagnostics& diagnostics)
{
  const auto make = makeResilientCheckers(options, resilience, open_device,
                                          [](const std::string& warning) { ROS_WARN_STREAM(warning); });
  return [make, &diagnostics](const std::shared_ptr<const PlanningScene>& scene)
  {
    std::shared_ptr<StateChecker> checker = make(scene);
    diagnostics.watch(checker);
    return checker;
  };
}
}  // namespace gpu_planning_scene::core
