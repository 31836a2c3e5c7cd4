#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gpu_planning_scene/CheckStates.h>

namespace gpu_planning_scene::core
{
struct ShardedCheckerOptions
{
  std::size_t part_states = 16384;  ///< most states of a part, at least 1
  double timeout = 30.0;   ///< seconds, more than 0: a node that has not answered a call by then, with the time
                           ///< to connect to it, counts as failed
  double patience = 10.0;  ///< seconds to try on while no node answers, at least 0
};

/// A client of several planning_scene_nodes with the same scene: a leader and nodes that follow it (~follow). It sends
/// the states of a large request in parts to all nodes. All parts of an answer belong to one revision of the scene, and
/// to the same values of the joints that the request does not name. A part that a node does not answer (it was killed,
/// is busy, shuts down, or does not have the revision) is sent to another node. Thread-safe.
class ShardedChecker
{
 public:
  using Request = gpu_planning_scene::CheckStates::Request;
  using Response = gpu_planning_scene::CheckStates::Response;

  /// `nodes`: the full names of the nodes, the leader first, for example "/planning_scene". ros::init must have been
  /// called; a program needs no NodeHandle. Throws Error for an empty list, a wrong name, and wrong options.
  explicit ShardedChecker(const std::vector<std::string>& nodes, const ShardedCheckerOptions& options = {});
  ~ShardedChecker();
  ShardedChecker(const ShardedChecker&) = delete;
  ShardedChecker& operator=(const ShardedChecker&) = delete;

  /// The answer of ~check_states. If the request names no revision, it is the newest one of the first node that
  /// answers: that of the leader, while it runs. `success` is false if all nodes refuse the request, or if no node has
  /// answered for `patience` seconds. `status` then has the reason of a node that refuses the request, or the last
  /// reason; UNAVAILABLE if a node has not replied. `message` names the node. `seconds` is the sum of the parts. These
  /// requests go to one node as a whole: at most 4096 states; with a scene_diff; with a joint for which neither the
  /// request nor the first node gives a value, for example a base whose pose only tf knows. A `status` that this
  /// version does not know is passed on; it counts as INTERNAL_ERROR. `is_cancelled`, if given, is called from several
  /// threads, about every 50 ms. Once it returns true, check() soon throws Cancelled.
  Response check(const Request& request, const std::function<bool()>& is_cancelled = {});

 private:
  struct Impl;
  class Call;
  const std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
