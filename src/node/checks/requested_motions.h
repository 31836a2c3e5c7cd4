#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "gpu_planning_scene/motion_checker.h"
#include "node/checks/check_services.h"

namespace gpu_planning_scene::core
{
/// The fields of a request that tell how its motions are checked.
struct RequestedMotions
{
  const std::string& rule;  ///< empty: the node's rule
  double resolution;
  double translation_resolution;
  const char* what;  ///< what messages call one of the motions
};

/// The options for a request's motions, and the number of samples of all motions. `starts`, `ends`: `count` full states
/// each. Throws Error for wrong fields, and for more samples than `limits` allows.
std::pair<MotionCheckerOptions, std::size_t> requestedMotions(const RequestedMotions& request, const RobotModel& robot,
                                                              const double* starts, const double* ends,
                                                              std::size_t count, const CheckServicesOptions& limits);

/// A warning if a joint is beyond its limits in one of `count` full states; otherwise empty. The rule "bound" proves no
/// motion there, even if the group does not move the joint.
/// `name_of`: what the warning calls a row of `states`.
std::string beyondLimits(const RobotModel& robot, const double* states, std::size_t count,
                         const std::function<std::string(std::size_t row)>& name_of);

/// A warning if a value is outside its joint limits, also one that the request takes from the current state; otherwise
/// empty. For the rule "samples", which checks such motions. `states`: `count` full rows.
std::string outsideLimits(const RobotModel& robot, const double* states, std::size_t count,
                          const std::function<std::string(std::size_t row)>& name_of);

/// A warning if motions are neither proven nor found in collision; otherwise empty. For the rule "bound", and motions
/// whose ends are within their limits. `what`: see RequestedMotions.
std::string unproven(const std::vector<MotionVerdict>& motions, const std::string& what);

/// A warning if the limit of checks left motions undecided; otherwise empty. `what`: see RequestedMotions.
std::string givenUp(const std::vector<MotionVerdict>& motions, std::size_t max_checks, const std::string& what);

/// A warning about the first continuous or planar joint that turns by more than half a turn between two rows of a path;
/// otherwise empty. A controller may turn it in the longer direction, which is not checked. `path`: full states.
std::string longTurn(const RobotModel& robot, const std::vector<double>& path,
                     const std::function<std::string(std::size_t row)>& name_of);
}  // namespace gpu_planning_scene::core
