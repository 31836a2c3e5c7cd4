#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <ros/ros.h>

#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// The services that a ShardedChecker calls, with answers that a test chooses. Its robot has the joint "joint" alone.
class FakeNode
{
 public:
  static constexpr std::uint64_t kRevision = 7;

  /// `statuses`: of the answers of ~check_states, one call after the other. The last one is that of all further calls.
  /// `revision`: of its scene.
  FakeNode(const std::string& name, std::vector<std::uint8_t> statuses, std::uint64_t answered_revision = kRevision,
           std::uint64_t revision = kRevision);

  /// The calls of ~check_states.
  std::size_t calls() const;

  static CheckStates::Request requestOf(std::size_t states);

 private:
  bool check(CheckStates::Request& request, CheckStates::Response& response);

  const std::vector<std::uint8_t> statuses_;
  const std::uint64_t answered_revision_;
  mutable std::mutex mutex_;  // guards the member below
  std::size_t calls_ = 0;
  ros::NodeHandle node_;
  std::vector<ros::ServiceServer> services_;
};
}  // namespace gpu_planning_scene::core
