#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "collision/batch_size.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// A queue of check requests, with the thread and the checker that answer them. A second thread with its own checker
/// relieves the first one: if a request of few states has waited for some milliseconds, because the current batch takes
/// long, the second thread answers it. If its checker cannot be made, the first thread answers all requests.
class CheckQueue
{
 public:
  /// `max_merged_states`: the largest number of states in a batch of merged requests; 0: requests are not merged.
  /// `make_relief`: makes the checker of the second thread when a batch takes long for the first time; null: there is
  /// no such thread.
  CheckQueue(const SceneStore& store, CheckServer::MakeChecker make_checker, const CheckServerOptions& options,
             std::size_t max_merged_states, CheckServer::MakeChecker make_relief = nullptr);
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
    std::chrono::steady_clock::time_point submitted;
    std::promise<CheckAnswer> answer;
  };
  using Batch = std::deque<Request>;
  /// What a thread needs to answer requests.
  struct Worker
  {
    CheckServer::MakeChecker make_checker;
    BatchSize batch_size;
    std::shared_ptr<StateChecker> checker = nullptr;
    std::shared_ptr<const PlanningScene> checked = nullptr;  // the checker's scene
  };

  void run();
  void relieve();
  bool isReliefReady() const;
  bool prepareRelief(std::unique_lock<std::mutex>& lock);
  void answerByRelief(Batch::iterator first, std::unique_lock<std::mutex>& lock);
  Batch nextBatch();
  Batch take(Batch::iterator first, std::size_t max_states);
  void answer(Batch& batch, Worker& worker);
  CheckAnswer check(Batch& batch, std::size_t count, Worker& worker);
  BatchResult checkStates(const std::vector<double>& states, std::size_t count, const std::string& group,
                          Worker& worker);
  void checkMotions(const CheckJob& job, const std::vector<double>& states, CheckAnswer& answer, Worker& worker);
  bool isStopping() const;
  std::vector<double> statesOf(Batch& batch, const Snapshot& now) const;
  /// Gives the checker the scene of the job and returns it.
  Snapshot takeScene(const CheckJob& job, Worker& worker) const;
  void countAnswered(const CheckAnswer& answer, std::size_t requests);
  void fail(Request& request, std::exception_ptr error);

  const SceneStore& store_;
  const CheckServerOptions options_;
  const std::size_t max_merged_states_;
  const std::size_t width_;

  Worker worker_;  // used by the queue's thread only. open() uses it too, before the thread starts
  Worker relief_;  // used by the second thread only; without a function that makes its checker, there is no such thread

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable wake_;
  Batch waiting_;
  std::size_t waiting_states_ = 0;
  // When the first thread began its current batch; max: it has none.
  std::chrono::steady_clock::time_point batch_start_ = std::chrono::steady_clock::time_point::max();
  bool stopping_ = false;
  CheckStatistics statistics_;
  std::thread thread_;  // last members: the threads use all members above
  std::thread relief_thread_;
};
}  // namespace gpu_planning_scene::core
