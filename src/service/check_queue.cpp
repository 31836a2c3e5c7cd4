#include "service/check_queue.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <system_error>

#include "model/seconds_since.h"

// The oldest request and all queued requests that can be merged with it are one batch, and each request gets its part
// of the answer. How long a batch takes is not known before, so a second thread answers the requests of few states that
// have waited too long. Own method.
namespace gpu_planning_scene::core
{
namespace
{
// stop() waits for the current batch of states, so a batch should take no longer than this.
constexpr double kBatchSeconds = 0.5;
constexpr std::size_t kLeastBatch = 16;    // states
constexpr std::size_t kFirstBatch = 1024;  // states

// Requests of at most this many states are answered by the second thread if they have waited for kPatience.
constexpr std::size_t kFewStates = 16;
constexpr std::chrono::milliseconds kPatience{10};
// When a batch takes longer than this, the second thread prepares its checker, although no request waits yet: the trees
// of a large robot take long.
constexpr std::chrono::milliseconds kSlowBatch{50};
// After the checker could not be made; doubled each time, up to the second number.
constexpr std::chrono::seconds kFirstRest{1};
constexpr std::chrono::seconds kLongestRest{60};

using Clock = std::chrono::steady_clock;
constexpr Clock::time_point kNever = Clock::time_point::max();

/// Whether the second thread may answer a request. Motions need an unknown number of checks, a report belongs to the
/// checker of the other states, and a checker may need much time to take over another scene or matrix.
bool suitsRelief(const CheckJob& job, std::size_t count)
{
  return count <= kFewStates && !job.motions && !job.report && !job.scene && !job.matrix;
}

std::exception_ptr shuttingDown()
{
  return std::make_exception_ptr(Error("shutting down: the request was not answered"));
}

bool isEqual(const std::shared_ptr<const AllowedCollisionMatrix>& a,
             const std::shared_ptr<const AllowedCollisionMatrix>& b)
{
  return a == b || (a && b && *a == *b);
}

/// Whether the rows already have all variables in the robot's order.
bool isFull(const CheckJob& job, std::size_t width)
{
  if (job.columns.empty())
    return true;
  for (std::size_t i = 0; i < job.columns.size(); ++i)
    if (job.columns[i] != static_cast<int>(i))
      return false;
  return job.columns.size() == width;
}

/// The job's states with all variables. Throws Error if a variable is neither given nor known.
std::vector<double> filled(const CheckJob& job, const Snapshot& now)
{
  const RobotModel& robot = *now.scene->robot;
  if (isFull(job, robot.variables().size()))
    return job.states;
  return fullStates(robot, job.columns, job.states.data(), job.states.size() / job.columns.size(), now.partialState());
}

/// Takes the answer of one request out of the answer of a merged batch. Rows of states have `width` values.
CheckAnswer part(const CheckAnswer& whole, std::size_t first, std::size_t count, bool keep_states, std::size_t width)
{
  const auto begin = static_cast<std::ptrdiff_t>(first);
  const auto end = static_cast<std::ptrdiff_t>(first + count);
  CheckAnswer answer;
  answer.scene = whole.scene;
  answer.device = whole.device;
  answer.result.revision = whole.result.revision;
  answer.result.seconds = whole.result.seconds;
  answer.result.valid.assign(whole.result.valid.begin() + begin, whole.result.valid.begin() + end);
  answer.result.colliding.assign(whole.result.colliding.begin() + begin, whole.result.colliding.begin() + end);
  if (keep_states)
    answer.states.assign(whole.states.begin() + begin * static_cast<std::ptrdiff_t>(width),
                         whole.states.begin() + end * static_cast<std::ptrdiff_t>(width));
  return answer;
}
}  // namespace

CheckQueue::CheckQueue(const SceneStore& store, CheckServer::MakeChecker make_checker,
                       const CheckServerOptions& options, std::size_t max_merged_states,
                       CheckServer::MakeChecker make_relief)
  : store_(store),
    options_(options),
    max_merged_states_(max_merged_states),
    width_(store.snapshot().scene->robot->variables().size()),
    worker_{std::move(make_checker), BatchSize({kBatchSeconds, kFirstBatch, kLeastBatch, options.max_batch_states})},
    relief_{std::move(make_relief), worker_.batch_size},
    thread_(),
    relief_thread_()
{
}

CheckQueue::~CheckQueue()
{
  stop();
}

void CheckQueue::open()
{
  takeScene({}, worker_);
}

std::future<CheckAnswer> CheckQueue::submit(CheckJob job, std::size_t count)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stopping_)
    std::rethrow_exception(shuttingDown());
  if (waiting_.size() >= options_.max_waiting_requests ||
      (!waiting_.empty() && waiting_states_ + count > options_.max_waiting_states))
  {
    ++statistics_.busy;
    throw Busy("busy: " + std::to_string(waiting_.size()) + " requests with " + std::to_string(waiting_states_) +
               " states are queued; send the request again later");
  }
  Request request;
  request.job = std::move(job);
  request.count = count;
  request.submitted = Clock::now();
  std::future<CheckAnswer> answer = request.answer.get_future();
  waiting_states_ += count;
  waiting_.push_back(std::move(request));
  if (!thread_.joinable())
    thread_ = std::thread([this] { run(); });
  try
  {
    if (relief_.make_checker && !relief_thread_.joinable())
      relief_thread_ = std::thread([this] { relieve(); });
  }
  catch (const std::system_error&)
  {
    // The other thread answers all requests.
  }
  wake_.notify_all();
  return answer;
}

void CheckQueue::stop()
{
  std::array<std::thread, 2> threads;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    threads[0].swap(thread_);
    threads[1].swap(relief_thread_);
    for (Request& request : waiting_)
      request.answer.set_exception(shuttingDown());
    waiting_.clear();
    waiting_states_ = 0;
  }
  wake_.notify_all();
  for (std::thread& thread : threads)
    if (thread.joinable())
      thread.join();
}

CheckStatistics CheckQueue::statistics() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  CheckStatistics statistics = statistics_;
  statistics.waiting_requests = waiting_.size();
  statistics.waiting_states = waiting_states_;
  return statistics;
}

void CheckQueue::run()
{
  for (Batch batch = nextBatch(); !batch.empty(); batch = nextBatch())
    answer(batch, worker_);
}

/// The second thread. It takes no request before its checker is ready for the newest scene: until then, the first
/// thread may answer the request sooner.
void CheckQueue::relieve()
{
  Clock::time_point rest;
  std::chrono::seconds next_rest = kFirstRest;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_)
  {
    const auto first = std::find_if(waiting_.begin(), waiting_.end(),
                                    [](const Request& request) { return suitsRelief(request.job, request.count); });
    Clock::time_point due = kNever;
    if (first != waiting_.end())
      due = first->submitted + kPatience;
    else if ((batch_start_ != kNever || !waiting_.empty()) && !isReliefReady())
      due = std::min(batch_start_, Clock::now()) + kSlowBatch;
    due = std::max(due, rest);
    if (due == kNever)
      wake_.wait(lock);
    else if (Clock::now() < due)
      wake_.wait_until(lock, due);
    else if (first != waiting_.end() && isReliefReady())
      answerByRelief(first, lock);
    else if (prepareRelief(lock))
      next_rest = kFirstRest;
    else
    {
      rest = Clock::now() + next_rest;
      next_rest = std::min(2 * next_rest, kLongestRest);
    }
  }
}

/// Whether the second thread's checker has the newest scene. Called by the second thread.
bool CheckQueue::isReliefReady() const
{
  return relief_.checked && store_.snapshot().scene == relief_.checked;
}

/// Gives the second thread's checker the newest scene, and checks one state, because the first check of a scene makes
/// the trees. Returns false if there is no checker: the first thread then answers the requests, or says what is wrong
/// with the scene. The caller holds the lock.
bool CheckQueue::prepareRelief(std::unique_lock<std::mutex>& lock)
{
  lock.unlock();
  bool is_ready = false;
  try
  {
    takeScene({}, relief_);
    relief_.checker->check(relief_.checked->robot->defaultState().data(), 1, "");
    is_ready = true;
  }
  catch (...)
  {
    // The first thread reports the error to those who ask.
  }
  lock.lock();
  return is_ready;
}

/// Answers a request of few states and those that can be merged with it. The caller holds the lock.
void CheckQueue::answerByRelief(Batch::iterator first, std::unique_lock<std::mutex>& lock)
{
  Batch batch = take(first, kFewStates);
  lock.unlock();
  answer(batch, relief_);
  batch.clear();  // perhaps the last owner of a scene, which must not be destroyed under the lock
  lock.lock();
}

/// Takes the oldest queued request and all requests that can be merged with it. Empty: the queue stops.
CheckQueue::Batch CheckQueue::nextBatch()
{
  std::unique_lock<std::mutex> lock(mutex_);
  batch_start_ = kNever;
  wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
  if (stopping_)
    return {};
  batch_start_ = Clock::now();
  return take(waiting_.begin(), max_merged_states_);
}

/// Takes a queued request and all later ones that can be merged with it, up to `max_states`. The caller holds the lock.
CheckQueue::Batch CheckQueue::take(Batch::iterator from, std::size_t max_states)
{
  Batch others(std::make_move_iterator(waiting_.begin()), std::make_move_iterator(from));
  Batch batch;
  batch.push_back(std::move(*from));
  std::size_t states = batch.front().count;
  for (auto request = std::next(from); request != waiting_.end(); ++request)
  {
    const CheckJob& first = batch.front().job;
    const CheckJob& next = request->job;
    const bool joins = !first.report && !next.report && !first.motions && !next.motions && !first.scene &&
                       !next.scene && states + request->count <= max_states && next.group == first.group &&
                       isEqual(next.matrix, first.matrix);
    states += joins ? request->count : 0;
    (joins ? batch : others).push_back(std::move(*request));
  }
  waiting_ = std::move(others);
  waiting_states_ -= states;
  return batch;
}

/// If a merged batch fails, each of its requests is checked alone, so that only the wrong requests get an error.
void CheckQueue::answer(Batch& batch, Worker& worker)
{
  try
  {
    std::size_t count = 0;
    for (const Request& request : batch)
      count += request.count;
    CheckAnswer whole;
    try
    {
      whole = check(batch, count, worker);
    }
    catch (...)
    {
      if (batch.size() == 1)
        throw;
      for (Request& request : batch)
      {
        Batch alone;
        alone.push_back(std::move(request));
        answer(alone, worker);
      }
      return;
    }
    countAnswered(whole, batch.size());
    if (batch.size() == 1)
    {
      batch.front().answer.set_value(std::move(whole));
      return;
    }
    std::size_t first = 0;
    for (Request& request : batch)
    {
      request.answer.set_value(part(whole, first, request.count, request.job.keep_states, width_));
      first += request.count;
    }
  }
  catch (...)
  {
    for (Request& request : batch)
      fail(request, std::current_exception());
  }
}

CheckAnswer CheckQueue::check(Batch& batch, std::size_t count, Worker& worker)
{
  const CheckJob& job = batch.front().job;
  const Snapshot now = takeScene(job, worker);
  std::vector<double> states = statesOf(batch, now);
  CheckAnswer answer;
  answer.scene = now.scene;
  if (job.motions)
    checkMotions(job, states, answer, worker);
  else
  {
    answer.result = checkStates(states, count, job.group, worker);
    answer.states_checked = count;
  }
  if (job.report)
    answer.report = worker.checker->report(job.group);
  if (std::any_of(batch.begin(), batch.end(), [](const Request& request) { return request.job.keep_states; }))
    answer.states = std::move(states);
  answer.device = worker.checker->deviceName();
  return answer;
}

/// Full states of all requests of the batch. A merged batch keeps the states of its jobs, because each request may have
/// to be checked alone afterwards. A single request gives its states away.
std::vector<double> CheckQueue::statesOf(Batch& batch, const Snapshot& now) const
{
  CheckJob& first = batch.front().job;
  if (batch.size() == 1)
    return isFull(first, width_) ? std::move(first.states) : filled(first, now);
  std::vector<double> states;
  for (const Request& request : batch)
  {
    const std::vector<double> rows = filled(request.job, now);
    states.insert(states.end(), rows.begin(), rows.end());
  }
  return states;
}

BatchResult CheckQueue::checkStates(const std::vector<double>& states, std::size_t count, const std::string& group,
                                    Worker& worker)
{
  BatchResult all;
  std::size_t from = 0;
  do  // at least once: the checker must see an unknown group even without states
  {
    if (from != 0 && isStopping())
      std::rethrow_exception(shuttingDown());
    const std::size_t rows = std::min(count - from, worker.batch_size.size());
    const BatchResult part = worker.checker->check(states.data() + from * width_, rows, group);
    worker.batch_size.took(rows, part.seconds);
    all.append(part);
    from += rows;
  } while (from < count);
  return all;
}

void CheckQueue::checkMotions(const CheckJob& job, const std::vector<double>& states, CheckAnswer& answer,
                              Worker& worker)
{
  const auto start = std::chrono::steady_clock::now();
  const MotionChecker checker(worker.checker, answer.scene->robot, job.group, *job.motions);
  const std::size_t rows = width_ == 0 ? 0 : states.size() / width_;
  std::size_t count = rows / 2;
  const double* ends = states.data() + count * width_;
  if (job.is_path)
  {
    answer.result = checkStates(states, rows, job.group, worker);
    answer.states_checked = rows;
    count = rows == 0 ? 0 : rows - 1;
    ends = states.data() + (rows == 0 ? 0 : width_);
  }
  else if (count == 0)
    worker.checker->check(nullptr, 0, job.group);  // the checker must see an unknown group even without motions
  answer.motions = checker.check(states.data(), ends, count, MotionQuery::LastValid, [this] { return isStopping(); });
  if (isStopping())
    std::rethrow_exception(shuttingDown());
  answer.states_checked += checker.statesChecked();
  answer.result.revision = answer.scene->revision;
  answer.result.seconds = secondsSince(start);
}

bool CheckQueue::isStopping() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return stopping_;
}

Snapshot CheckQueue::takeScene(const CheckJob& job, Worker& worker) const
{
  Snapshot now = job.scene ? *job.scene : store_.snapshot();
  if (job.matrix)
  {
    auto other = std::make_shared<PlanningScene>(*now.scene);
    other->allowed_collisions = *job.matrix;
    other->matrix_source = MatrixSource::SceneFile;
    now.scene = std::move(other);
  }
  if (now.scene == worker.checked)
    return now;
  try
  {
    if (worker.checker)
      worker.checker->setScene(now.scene);
    else
      worker.checker = worker.make_checker(now.scene);
    worker.checked = now.scene;
    worker.batch_size.restart();
  }
  catch (...)
  {
    worker.checker.reset();
    worker.checked.reset();
    throw;
  }
  return now;
}

void CheckQueue::countAnswered(const CheckAnswer& answer, std::size_t requests)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  statistics_.requests += requests;
  statistics_.batches += 1;
  statistics_.states += answer.states_checked;
  statistics_.undecided += answer.result.undecided_states;
}

/// Requests that already have an answer keep it.
void CheckQueue::fail(Request& request, std::exception_ptr error)
{
  try
  {
    request.answer.set_exception(std::move(error));
  }
  catch (const std::future_error&)
  {
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  ++statistics_.errors;
}
}  // namespace gpu_planning_scene::core
