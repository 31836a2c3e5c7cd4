#pragma once

#include <cstdint>
#include <future>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// Logs the report of the first scene. During its lifetime, it then warns of each change after which bodies collide in
/// every state, and once if passive joints have default values. It looks at the newest scene once a second, so that
/// many changes cost one report. All arguments must outlive it.
class SceneWatch
{
 public:
  /// Throws the errors of the checker.
  SceneWatch(ros::NodeHandle& own, const SceneStore& store, CheckServer& server);

 private:
  void look();
  void warnOfPassiveJoints();
  void take(const CheckAnswer& answer);

  const SceneStore& store_;
  CheckServer& server_;
  std::uint64_t revision_ = 0;         // of the last report
  std::vector<std::string> warnings_;  // of the last report
  bool has_warned_of_passive_joints_ = false;
  std::future<CheckAnswer> answer_;  // valid while a report is under way
  ros::WallTimer timer_;             // last: its callbacks use the other members
};
}  // namespace gpu_planning_scene::core
