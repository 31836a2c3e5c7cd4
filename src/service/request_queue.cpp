#include "service/request_queue.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

// Own method.
namespace gpu_planning_scene::core
{
namespace
{
// Requests of at most this many states are answered by the second thread if they have waited for kPatience.
constexpr std::size_t kFewStates = 16;
constexpr std::chrono::milliseconds kPatience{10};
// When a batch takes longer than this, the second thread prepares its checker, although no request waits yet: the trees
// of a large robot take long.
constexpr std::chrono::milliseconds kSlowBatch{50};

using Clock = std::chrono::steady_clock;
constexpr Clock::time_point kNever = Clock::time_point::max();

bool hasFewStates(const CheckRequest& request)
{
  return request.count <= kFewStates;
}

/// Whether the second thread may answer a request. Motions need an unknown number of checks, a report belongs to the
/// checker of the other states, and a checker may need much time to take over another scene or matrix.
bool isForSecondThread(const CheckRequest& request)
{
  const CheckJob& job = request.job;
  return hasFewStates(request) && !job.motions && !job.report && !job.scene && !job.matrix;
}

bool isEqual(const std::shared_ptr<const AllowedCollisionMatrix>& a,
             const std::shared_ptr<const AllowedCollisionMatrix>& b)
{
  return a == b || (a && b && *a == *b);
}

/// Whether one batch can have the states of both requests. A request of few states does not wait for many others.
bool canMerge(const CheckRequest& first, const CheckRequest& second)
{
  const CheckJob& a = first.job;
  const CheckJob& b = second.job;
  return hasFewStates(first) == hasFewStates(second) && !a.report && !b.report && !a.motions && !b.motions &&
         !a.scene && !b.scene && a.group == b.group && isEqual(a.matrix, b.matrix);
}
}  // namespace

std::future<CheckAnswer> RequestQueue::submit(CheckJob job, std::size_t count)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stopping_)
    throw ShuttingDown();
  if (waiting_.size() >= options_.max_waiting_requests ||
      (!waiting_.empty() && waiting_states_ + count > options_.max_waiting_states))
  {
    ++busy_;
    throw Busy("busy: " + std::to_string(waiting_.size()) + " requests with " + std::to_string(waiting_states_) +
               " states are queued; send the request again later");
  }
  CheckRequest request;
  request.job = std::move(job);
  request.count = count;
  request.submitted = Clock::now();
  std::future<CheckAnswer> answer = request.answer.get_future();
  waiting_states_ += count;
  waiting_.push_back(std::move(request));
  wake_.notify_all();
  return answer;
}

CheckBatch RequestQueue::takeOldest()
{
  std::unique_lock<std::mutex> lock(mutex_);
  batch_start_ = kNever;
  wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
  if (stopping_)
    return {};
  batch_start_ = Clock::now();
  return take(0, max_merged_states_);
}

std::optional<CheckBatch> RequestQueue::takeOverdue(const std::function<bool()>& is_ready, Clock::time_point rest)
{
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_)
  {
    const auto first = std::find_if(waiting_.begin(), waiting_.end(), isForSecondThread);
    Clock::time_point due = kNever;
    if (first != waiting_.end())
      due = first->submitted + kPatience;
    else if ((batch_start_ != kNever || !waiting_.empty()) && !is_ready())
      due = std::min(batch_start_, Clock::now()) + kSlowBatch;
    due = std::max(due, rest);
    if (due == kNever)
      wake_.wait(lock);
    else if (Clock::now() < due)
      wake_.wait_until(lock, due);
    else if (first != waiting_.end() && is_ready())
      return take(static_cast<std::size_t>(first - waiting_.begin()), kFewStates);
    else
      return CheckBatch();
  }
  return std::nullopt;
}

/// Takes a queued request and all later ones that can be merged with it, up to `max_states`. The caller holds the lock.
CheckBatch RequestQueue::take(std::size_t first, std::size_t max_states)
{
  CheckBatch batch;
  CheckBatch others;
  std::size_t states = 0;
  for (std::size_t i = 0; i < waiting_.size(); ++i)
  {
    CheckRequest& request = waiting_[i];
    const bool joins =
        i == first || (i > first && states + request.count <= max_states && canMerge(batch.front(), request));
    states += joins ? request.count : 0;
    (joins ? batch : others).push_back(std::move(request));
  }
  waiting_ = std::move(others);
  waiting_states_ -= states;
  return batch;
}

void RequestQueue::stop()
{
  CheckBatch unanswered;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    unanswered.swap(waiting_);
    waiting_states_ = 0;
  }
  for (CheckRequest& request : unanswered)
    request.answer.set_exception(std::make_exception_ptr(ShuttingDown()));
  wake_.notify_all();
}

bool RequestQueue::isStopping() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return stopping_;
}

CheckStatistics RequestQueue::statistics() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  CheckStatistics statistics;
  statistics.busy = busy_;
  statistics.waiting_requests = waiting_.size();
  statistics.waiting_states = waiting_states_;
  return statistics;
}
}  // namespace gpu_planning_scene::core
