#pragma once

#include <cstddef>
#include <future>
#include <mutex>
#include <thread>

#include "service/check_server.h"
#include "service/check_worker.h"
#include "service/request_queue.h"

namespace gpu_planning_scene::core
{
/// A queue of check requests, with the thread and the checker that answer them. A second thread with its own checker
/// relieves the first one: if a request of few states has waited for some milliseconds, because the current batch takes
/// long, the second thread answers it. If its checker cannot be made, the first thread answers all requests.
/// Thread-safe.
class CheckQueue
{
 public:
  /// `max_merged_states`: the largest number of states in a batch of merged requests; 0: requests are not merged.
  /// `make_relief`: makes the checker of the second thread when a batch takes long for the first time; null: there is
  /// no such thread.
  CheckQueue(const SceneStore& store, MakeChecker make_checker, const CheckServerOptions& options,
             std::size_t max_merged_states, const MakeChecker& make_relief = nullptr);
  ~CheckQueue();

  /// Makes the checker before the first request arrives. Throws the errors of `make_checker`.
  void open() { worker_.open(); }
  /// Throws Busy, ShuttingDown, and std::system_error if the thread cannot start.
  std::future<CheckAnswer> submit(CheckJob job, std::size_t count);
  /// Rejects queued and later requests, and ends the running one soon. Does not wait.
  void refuse();
  /// Calls refuse(), waits for the running batch, and drops the checkers. One caller at a time.
  void stop();
  CheckStatistics statistics() const;

 private:
  void startThreads();
  void run();
  void relieve();
  void count(const CheckStatistics& answered);

  RequestQueue requests_;
  // A thread each; open() uses the first one before the threads start, and stop() both of them after they have ended.
  CheckWorker worker_;
  CheckWorker relief_;
  const bool has_relief_;

  mutable std::mutex mutex_;  // guards the members below
  CheckStatistics answered_;
  std::thread thread_;  // last members: the threads use all members above
  std::thread relief_thread_;
};
}  // namespace gpu_planning_scene::core
