#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <ros/node_handle.h>

#include "node/watch/rest_checker.h"

namespace gpu_planning_scene::core
{
struct WatcherOptions
{
  double rate = 20.0;              ///< checks per second while the scene does not change: ~watch/rate
  std::size_t max_watched = 64;    ///< trajectories
  std::size_t max_rows = 100'000;  ///< of all trajectories together
  double longest_check = 1.0;      ///< seconds; a check that takes longer ends with the verdict UNKNOWN
  MotionCheckerOptions motions = {};
};

/// Answers ~watch_trajectory and publishes ~watch. One thread owns the list of watched trajectories. It checks their
/// rest at each change of the list or the scene, and at a rate. Changes that come during a check cause one further
/// check. Thread-safe.
class TrajectoryWatcher
{
 public:
  /// `store` must outlive the watcher. `make_checker`, `inspector_of`: see RestChecker. `require_scene`: throws Error
  /// while the scene is not known, for example because the node that this one follows is lost.
  TrajectoryWatcher(ros::NodeHandle& node, ros::NodeHandle& own, SceneStore& store, MakeChecker make_checker,
                    RestChecker::InspectorOf inspector_of, std::function<void()> require_scene,
                    const WatcherOptions& options);
  /// Calls stop().
  ~TrajectoryWatcher();

  /// Throws nothing: the response has the error. The call blocks until the first verdict.
  WatchTrajectory::Response watch(const WatchTrajectory::Request& request);

  /// Ends the thread; nothing is watched any more. Waiting and later requests get ShuttingDown.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  /// A change of the list: a new trajectory, or the name of one that is not watched any more.
  struct Order
  {
    std::optional<Watched> added;
    std::string removed;
    std::promise<WatchState> answer;
  };

  Watched newWatched(const WatchTrajectory::Request& request, std::string& warnings);
  std::future<WatchState> submit(Order order);

  // The functions and members below belong to the thread.
  void run();
  void take(std::vector<Order>& orders);
  void carryOut(Order& order);
  WatchState look(bool with_contact);
  void cancelGoals(const WatchState& state);

  ros::NodeHandle node_;
  SceneStore& store_;
  const std::function<void()> require_scene_;
  const WatcherOptions options_;
  ros::Publisher publisher_;
  std::vector<Watched> watched_;
  std::vector<std::string> ended_;  // since the last message
  bool has_said_the_end_ = false;
  RestChecker rest_checker_;

  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::vector<Order> orders_;
  std::optional<Clock::time_point> scene_changed_;  // since the last check began
  std::atomic<bool> stopping_{false};               // is read without the mutex too
  std::thread thread_;                              // last: it uses the other members
};
}  // namespace gpu_planning_scene::core
