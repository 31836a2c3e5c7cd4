#include "collision/proofs/proof_worker.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <exception>
#include <iterator>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

// One thread of the process takes the jobs of all checkers in turns, with a low priority, because checks come first. So
// the proofs of one robot do not wait for all tables of another robot. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

constexpr int kNice = 5;  // of the threads that make proofs, added to that of the process
// If other jobs wait, a job ends its turn after this time, between two covers or tables.
constexpr std::chrono::milliseconds kTurnTime{500};

/// Lowers the priority of this thread and of the threads that it starts: checks come first. The thread may have been
/// started by a real-time thread, whose policy it then has.
void lowerPriority()
{
  const sched_param normal{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &normal);
  constexpr int kThisThread = 0;  // on Linux
  setpriority(PRIO_PROCESS, kThisThread, getpriority(PRIO_PROCESS, kThisThread) + kNice);
}
}  // namespace

/// A thread that makes proofs. The jobs take turns.
class ProofWorker
{
 public:
  /// The worker is ended when the process ends, but never destroyed: a child that was forked from the process does not
  /// have its thread, and would wait for it for ever.
  static ProofWorker& instance()
  {
    static ProofWorker* const worker = []
    {
      std::atexit([] { instance().end(); });
      return new ProofWorker;
    }();
    return *worker;
  }

  ProofWorker(const ProofWorker&) = delete;
  ProofWorker& operator=(const ProofWorker&) = delete;

  /// `makes` true: missing proofs are made. False: the job gets proofs only if none is missing.
  std::shared_ptr<ProofJob> add(std::shared_ptr<const RobotModel> robot,
                                std::shared_ptr<const CollisionProblem> problem,
                                std::shared_ptr<const CpuForest> forest, bool makes)
  {
    auto job = std::make_shared<ProofJob>();
    if (getpid() != process_)
      return job;                 // a forked child has no thread for it, so the exact checker decides all states
    std::vector<Task> abandoned;  // may hold the last references to large objects, so it ends after the lock
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const auto first =
          std::stable_partition(tasks_.begin(), tasks_.end(), [](const Task& task) { return !task.job.expired(); });
      abandoned.assign(std::make_move_iterator(first), std::make_move_iterator(tasks_.end()));
      tasks_.erase(first, tasks_.end());
      // To load proofs takes milliseconds, so these jobs come first.
      tasks_.insert(makes ? tasks_.end() : tasks_.begin(),
                    {job, std::move(robot), std::move(problem), std::move(forest), makes});
      try
      {
        if (!thread_.joinable())
          thread_ = std::thread([this] { work(); });
      }
      catch (const std::system_error&)
      {
        tasks_.clear();  // without a thread there are no proofs, and the exact checker decides all states
      }
    }
    changed_.notify_all();
    return job;
  }

  void wait()
  {
    if (getpid() != process_)
      return;
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return tasks_.empty() && !busy_; });
  }

 private:
  struct Task
  {
    std::weak_ptr<ProofJob> job;
    std::shared_ptr<const RobotModel> robot;
    std::shared_ptr<const CollisionProblem> problem;
    std::shared_ptr<const CpuForest> forest;
    bool makes;
  };

  ProofWorker() = default;

  void end()
  {
    if (getpid() != process_)
      return;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable())
      thread_.join();
  }

  void work()
  {
    lowerPriority();
    std::unique_lock<std::mutex> lock(mutex_);
    while (true)
    {
      changed_.wait(lock, [this] { return ending_ || !tasks_.empty(); });
      if (ending_)
        return;
      Task task = std::move(tasks_.front());
      tasks_.pop_front();
      busy_ = true;
      lock.unlock();
      const bool is_complete = run(task);
      const bool is_over = is_complete || task.job.expired();
      if (is_over)
        task = {};  // the last references to large objects may end here, not under the lock
      lock.lock();
      if (!is_over)
        tasks_.push_back(std::move(task));
      busy_ = false;
      changed_.notify_all();
    }
  }

  /// Gives a job its turn. Returns whether there is nothing more to do.
  bool run(const Task& task)
  {
    const Clock::time_point start = Clock::now();
    const auto is_stopped = [&] { return ending_ || task.job.expired(); };
    const auto is_paused = [&] { return Clock::now() - start > kTurnTime && isAnyWaiting(); };
    const auto publish = [&](RobotProofs proofs)
    {
      if (const std::shared_ptr<ProofJob> job = task.job.lock())
        std::atomic_store(&job->proofs_, std::make_shared<const RobotProofs>(std::move(proofs)));
    };
    // Not held on: a job that nobody else holds is abandoned.
    const auto published_of = [](const std::shared_ptr<const ProofJob>& job) { return job ? job->proofs() : nullptr; };
    const std::shared_ptr<const RobotProofs> published = published_of(task.job.lock());
    try
    {
      if (task.makes)
        return prover_.prove(*task.robot, *task.problem, task.forest, ProofCache::ofUser(), publish, is_stopped,
                             is_paused, published.get());
      prover_.load(*task.robot, *task.problem, task.forest, ProofCache::ofUser(), publish, is_stopped);
    }
    catch (const std::exception&)
    {
      // Without proofs, the exact checker decides all states.
    }
    return true;
  }

  bool isAnyWaiting()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::any_of(tasks_.begin(), tasks_.end(), [](const Task& task) { return !task.job.expired(); });
  }

  std::mutex mutex_;  // guards the tasks and busy_
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  bool busy_ = false;
  std::atomic<bool> ending_{false};
  RobotProver prover_;  // used by the thread only
  std::thread thread_;
  const pid_t process_ = getpid();
};

std::shared_ptr<ProofJob> proveInBackground(std::shared_ptr<const RobotModel> robot,
                                            std::shared_ptr<const CollisionProblem> problem,
                                            std::shared_ptr<const CpuForest> forest)
{
  return ProofWorker::instance().add(std::move(robot), std::move(problem), std::move(forest), true);
}

std::shared_ptr<ProofJob> loadProofsInBackground(std::shared_ptr<const RobotModel> robot,
                                                 std::shared_ptr<const CollisionProblem> problem,
                                                 std::shared_ptr<const CpuForest> forest)
{
  return ProofWorker::instance().add(std::move(robot), std::move(problem), std::move(forest), false);
}

void waitForProofs()
{
  ProofWorker::instance().wait();
}
}  // namespace gpu_planning_scene::core
