#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <optional>

#include "service/check_server.h"

namespace gpu_planning_scene::core
{
struct CheckRequest
{
  CheckJob job;
  std::size_t count = 0;  ///< states
  std::chrono::steady_clock::time_point submitted;
  std::promise<CheckAnswer> answer;
};
using CheckBatch = std::deque<CheckRequest>;

/// The queued check requests. Two threads take requests: the first one takes all kinds of them, in their order; the
/// second one takes requests of few states that have waited too long, because it is not known in advance how long a
/// batch of the first thread takes. Thread-safe.
class RequestQueue
{
 public:
  /// `max_merged_states`: the largest number of states in a batch of merged requests; 0: requests are not merged.
  RequestQueue(const CheckServerOptions& options, std::size_t max_merged_states)
    : options_(options), max_merged_states_(max_merged_states)
  {
  }

  /// Throws Busy if the queue is full, and ShuttingDown after stop().
  std::future<CheckAnswer> submit(CheckJob job, std::size_t count);

  /// For the first thread: waits for a request, and takes the oldest one and all that can be merged with it. The batch
  /// lasts until the next call. Empty: the queue stops.
  CheckBatch takeOldest();

  /// For the second thread: waits until a request of few states has waited too long, and takes it and those that can be
  /// merged with it. Returns an empty batch if the checker should first be prepared: a request or a batch takes long,
  /// and the checker is not ready, so the first thread may answer the request sooner. Returns nothing before `rest`. No
  /// value: the queue stops. `is_ready`: whether the checker has the newest scene; must not call the queue.
  std::optional<CheckBatch> takeOverdue(const std::function<bool()>& is_ready,
                                        std::chrono::steady_clock::time_point rest);

  /// All queued and later requests get ShuttingDown, and waiting threads return.
  void stop();
  bool isStopping() const;

  /// The lengths of the queue and the number of its refusals.
  CheckStatistics statistics() const;

 private:
  CheckBatch take(std::size_t first, std::size_t max_states);

  const CheckServerOptions options_;
  const std::size_t max_merged_states_;

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable wake_;
  CheckBatch waiting_;
  std::size_t waiting_states_ = 0;
  std::uint64_t busy_ = 0;
  // When the first thread began its current batch; max: it has none.
  std::chrono::steady_clock::time_point batch_start_ = std::chrono::steady_clock::time_point::max();
  bool stopping_ = false;
};
}  // namespace gpu_planning_scene::core
