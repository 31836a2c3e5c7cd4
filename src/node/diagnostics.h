#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/node_handle.h>

#include "gpu_planning_scene/state_checker.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// What the node is doing, for people and for those who watch over it: /diagnostics, once a second.
class Diagnostics
{
 public:
  /// The checkers that are there; they may go.
  void watch(const std::shared_ptr<const StateChecker>& checker);
  /// A message or request that was not used, and why.
  void refused(const std::string& why);

  /// Since the last call the rate. OK; WARN: the CPU stands in for a device; ERROR: for one that could not be had
  /// again.
  diagnostic_msgs::DiagnosticStatus status(const SceneStore& store, const CheckServer& server);

 private:
  std::mutex mutex_;
  std::vector<std::weak_ptr<const StateChecker>> checkers_;
  std::uint64_t refused_ = 0;
  std::string last_refusal_;
  std::uint64_t states_ = 0;
  std::chrono::steady_clock::time_point at_ = std::chrono::steady_clock::now();
};

/// Publishes it as long as it lives. All arguments outlive it.
class DiagnosticsPublisher
{
 public:
  DiagnosticsPublisher(ros::NodeHandle& node, Diagnostics& diagnostics, const SceneStore& store,
                       const CheckServer& server);

 private:
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};
}  // namespace gpu_planning_scene::core
