#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "collision/batch_size.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// A queue of check requests, with the thread and the checker that answer them.
class CheckQueue
{
 public:
  /// `max_merged_states`: the largest number of states in a batch of merged requests; 0: requests are not merged.
  CheckQueue(const SceneStore& store, CheckServer::MakeChecker make_checker, const CheckServerOptions& options,
             std::size_t max_merged_states);
  ~CheckQueue();

  /// Makes the checker before the first request arrives. Throws the errors of `make_checker`.
  void open();
  std::size_t stateWidth() const { return width_; }
  std::future<CheckAnswer> submit(CheckJob job, std::size_t count);
  void stop();
  CheckStatistics statistics() const;

 private:
  struct Request
  {
    CheckJob job;
    std::size_t count = 0;
    std::promise<CheckAnswer> answer;
  };
  using Batch = std::deque<Request>;

  void run();
  Batch nextBatch();
  void answer(Batch& batch);
  CheckAnswer check(Batch& batch, std::size_t count);
  BatchResult checkStates(const std::vector<double>& states, std::size_t count, const std::string& group);
  void checkMotions(const CheckJob& job, const std::vector<double>& states, CheckAnswer& answer);
  bool isStopping() const;
  std::vector<double> statesOf(Batch& batch, const Snapshot& now) const;
  /// Gives the checker the scene of the job and returns it.
  Snapshot takeScene(const CheckJob& job);
  void countAnswered(const CheckAnswer& answer, std::size_t requests);
  void fail(Request& request, std::exception_ptr error);

  const SceneStore& store_;
  const CheckServer::MakeChecker make_checker_;
  const CheckServerOptions options_;
  const std::size_t max_merged_states_;
  const std::size_t width_;

  // Used by the queue's thread only. open() uses them too, before the thread starts.
  std::shared_ptr<StateChecker> checker_;
  std::shared_ptr<const PlanningScene> checked_;  // the checker's scene
  BatchSize batch_size_;

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable wake_;
  Batch waiting_;
  std::size_t waiting_states_ = 0;
  bool stopping_ = false;
  CheckStatistics statistics_;
  std::thread thread_;  // last member: the thread uses all members above
};
}  // namespace gpu_planning_scene::core
