#include "service/check_queue.h"

#include <algorithm>
#include <chrono>

#include "model/seconds_since.h"

// The oldest request and all queued requests that can be merged with it are one batch, and each request gets its part
// of the answer. Own method.
namespace gpu_planning_scene::core
{
namespace
{
// stop() waits for the current batch of states, so a batch should take no longer than this.
constexpr double kBatchSeconds = 0.5;
constexpr std::size_t kLeastBatch = 16;    // states
constexpr std::size_t kFirstBatch = 1024;  // states

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
                       const CheckServerOptions& options, std::size_t max_merged_states)
  : store_(store),
    make_checker_(std::move(make_checker)),
    options_(options),
    max_merged_states_(max_merged_states),
    width_(store.snapshot().scene->robot->variables().size()),
    batch_size_({kBatchSeconds, kFirstBatch, kLeastBatch, options.max_batch_states}),
    thread_()
{
}

CheckQueue::~CheckQueue()
{
  stop();
}

void CheckQueue::open()
{
  takeScene({});
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
  std::future<CheckAnswer> answer = request.answer.get_future();
  waiting_states_ += count;
  waiting_.push_back(std::move(request));
  if (!thread_.joinable())
    thread_ = std::thread([this] { run(); });
  wake_.notify_one();
  return answer;
}

void CheckQueue::stop()
{
  std::thread thread;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    thread.swap(thread_);
    for (Request& request : waiting_)
      request.answer.set_exception(shuttingDown());
    waiting_.clear();
    waiting_states_ = 0;
  }
  wake_.notify_one();
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
    answer(batch);
}

/// Takes the oldest queued request and all requests that can be merged with it. Empty: the queue stops.
CheckQueue::Batch CheckQueue::nextBatch()
{
  std::unique_lock<std::mutex> lock(mutex_);
  wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
  Batch batch;
  if (stopping_)
    return batch;
  batch.push_back(std::move(waiting_.front()));
  waiting_.pop_front();
  std::size_t states = batch.front().count;
  Batch others;
  for (Request& request : waiting_)
  {
    const CheckJob& first = batch.front().job;
    const bool joins = !first.report && !request.job.report && !first.motions && !request.job.motions && !first.scene &&
                       !request.job.scene && states + request.count <= max_merged_states_ &&
                       request.job.group == first.group && isEqual(request.job.matrix, first.matrix);
    states += joins ? request.count : 0;
    (joins ? batch : others).push_back(std::move(request));
  }
  waiting_ = std::move(others);
  waiting_states_ -= states;
  return batch;
}

/// If a merged batch fails, each of its requests is checked alone, so that only the wrong requests get an error.
void CheckQueue::answer(Batch& batch)
{
  try
  {
    std::size_t count = 0;
    for (const Request& request : batch)
      count += request.count;
    CheckAnswer whole;
    try
    {
      whole = check(batch, count);
    }
    catch (...)
    {
      if (batch.size() == 1)
        throw;
      for (Request& request : batch)
      {
        Batch alone;
        alone.push_back(std::move(request));
        answer(alone);
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

CheckAnswer CheckQueue::check(Batch& batch, std::size_t count)
{
  const CheckJob& job = batch.front().job;
  const Snapshot now = takeScene(job);
  std::vector<double> states = statesOf(batch, now);
  CheckAnswer answer;
  answer.scene = now.scene;
  if (job.motions)
    checkMotions(job, states, answer);
  else
  {
    answer.result = checkStates(states, count, job.group);
    answer.states_checked = count;
  }
  if (job.report)
    answer.report = checker_->report(job.group);
  if (std::any_of(batch.begin(), batch.end(), [](const Request& request) { return request.job.keep_states; }))
    answer.states = std::move(states);
  answer.device = checker_->deviceName();
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

BatchResult CheckQueue::checkStates(const std::vector<double>& states, std::size_t count, const std::string& group)
{
  BatchResult all;
  std::size_t from = 0;
  do  // at least once: the checker must see an unknown group even without states
  {
    if (from != 0 && isStopping())
      std::rethrow_exception(shuttingDown());
    const std::size_t rows = std::min(count - from, batch_size_.size());
    const BatchResult part = checker_->check(states.data() + from * width_, rows, group);
    batch_size_.took(rows, part.seconds);
    all.append(part);
    from += rows;
  } while (from < count);
  return all;
}

void CheckQueue::checkMotions(const CheckJob& job, const std::vector<double>& states, CheckAnswer& answer)
{
  const auto start = std::chrono::steady_clock::now();
  const MotionChecker checker(checker_, answer.scene->robot, job.group, *job.motions);
  const std::size_t rows = width_ == 0 ? 0 : states.size() / width_;
  std::size_t count = rows / 2;
  const double* ends = states.data() + count * width_;
  if (job.is_path)
  {
    answer.result = checkStates(states, rows, job.group);
    answer.states_checked = rows;
    count = rows == 0 ? 0 : rows - 1;
    ends = states.data() + (rows == 0 ? 0 : width_);
  }
  else if (count == 0)
    checker_->check(nullptr, 0, job.group);  // the checker must see an unknown group even without motions
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

Snapshot CheckQueue::takeScene(const CheckJob& job)
{
  Snapshot now = job.scene ? *job.scene : store_.snapshot();
  if (job.matrix)
  {
    auto other = std::make_shared<PlanningScene>(*now.scene);
    other->allowed_collisions = *job.matrix;
    other->matrix_source = MatrixSource::SceneFile;
    now.scene = std::move(other);
  }
  if (now.scene == checked_)
    return now;
  try
  {
    if (checker_)
      checker_->setScene(now.scene);
    else
      checker_ = make_checker_(now.scene);
    checked_ = now.scene;
    batch_size_.restart();
  }
  catch (...)
  {
    checker_.reset();
    checked_.reset();
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
