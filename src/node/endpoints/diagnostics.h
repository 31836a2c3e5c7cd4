#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/node_handle.h>

#include "gpu_planning_scene/state_checker.h"
#include "service/check_server.h"
#include "service/make_checker.h"

namespace gpu_planning_scene::core
{
/// Collects the status of the node for /diagnostics. Thread-safe.
class Diagnostics
{
 public:
  /// Returns a function that makes checkers with `make` and adds each checker to the status, for as long as the checker
  /// exists. This object must outlive the function.
  MakeChecker watched(const MakeChecker& make);
  /// Adds the fault of the scene to the status. `fault`: returns the reason why the scene is not known; empty if it is
  /// known. Thread-safe.
  void watchScene(std::function<std::string()> fault);
  /// Counts a rejected message or request. `why`: the reason.
  void refused(const std::string& why);

  /// The level is WARN if the CPU answers for a lost device, ERROR if the device could not be opened again or the scene
  /// is not known, else OK.
  /// The rate of states is counted since the last call. Logs once when the CPU takes over, and once when it ends.
  diagnostic_msgs::DiagnosticStatus status(const SceneStore& store, const CheckServer& server);

 private:
  void logDevice(const std::string& fault);

  std::mutex mutex_;
  std::string logged_fault_;
  std::vector<std::weak_ptr<const StateChecker>> checkers_;
  std::function<std::string()> scene_fault_;
  std::uint64_t refused_ = 0;
  std::string last_refusal_;
  std::uint64_t states_ = 0;
  std::chrono::steady_clock::time_point at_ = std::chrono::steady_clock::now();
};

/// Publishes the status on /diagnostics once a second during its lifetime. All arguments must outlive it.
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
