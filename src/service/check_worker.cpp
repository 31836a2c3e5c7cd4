#include "service/check_worker.h"

#include <algorithm>
#include <future>
#include <iterator>
#include <utility>

#include "base/seconds_since.h"

namespace gpu_planning_scene::core
{
namespace
{
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

std::size_t widthOf(const Snapshot& now)
{
  return now.scene->robot->variables().size();
}

/// The job's states with all variables. Throws NotKnownYet if a variable is neither given nor known.
std::vector<double> filled(const CheckJob& job, const Snapshot& now)
{
  if (isFull(job, widthOf(now)))
    return job.states;
  return fullStates(*now.scene->robot, job.columns, job.states.data(), job.states.size() / job.columns.size(),
                    now.partialState());
}

/// Full states of all requests of the batch. A merged batch keeps the states of its jobs, because each request may have
/// to be checked alone afterwards. A single request gives its states away.
std::vector<double> statesOf(CheckBatch& batch, const Snapshot& now)
{
  CheckJob& first = batch.front().job;
  if (batch.size() == 1)
    return isFull(first, widthOf(now)) ? std::move(first.states) : filled(first, now);
  std::vector<double> states;
  for (const CheckRequest& request : batch)
  {
    const std::vector<double> rows = filled(request.job, now);
    states.insert(states.end(), rows.begin(), rows.end());
  }
  return states;
}

/// Takes the answer of one request out of the answer of a merged batch.
CheckAnswer part(const CheckAnswer& whole, std::size_t first, const CheckRequest& request)
{
  const auto begin = static_cast<std::ptrdiff_t>(first);
  const auto end = static_cast<std::ptrdiff_t>(first + request.count);
  const auto width = static_cast<std::ptrdiff_t>(whole.scene->robot->variables().size());
  CheckAnswer answer;
  answer.scene = whole.scene;
  answer.device = whole.device;
  answer.result.revision = whole.result.revision;
  answer.result.seconds = whole.result.seconds;
  answer.result.valid.assign(whole.result.valid.begin() + begin, whole.result.valid.begin() + end);
  answer.result.colliding.assign(whole.result.colliding.begin() + begin, whole.result.colliding.begin() + end);
  if (request.job.keep_states)
    answer.states.assign(whole.states.begin() + begin * width, whole.states.begin() + end * width);
  return answer;
}
}  // namespace

CheckWorker::CheckWorker(const SceneStore& store, const RequestQueue& queue, MakeChecker make_checker, Count count)
  : store_(store), queue_(queue), make_checker_(std::move(make_checker)), count_(std::move(count))
{
}

void CheckWorker::prepare()
{
  takeScene({});
  try
  {
    checker_->check(checked_->robot->defaultState().data(), 1, "");
  }
  catch (...)
  {
    close();
    throw;
  }
}

void CheckWorker::answer(CheckBatch& batch)
{
  try
  {
    std::size_t count = 0;
    for (const CheckRequest& request : batch)
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
      for (CheckRequest& request : batch)
      {
        CheckBatch alone;
        alone.push_back(std::move(request));
        answer(alone);
      }
      return;
    }
    CheckStatistics answered;
    answered.requests = batch.size();
    answered.batches = 1;
    answered.states = whole.states_checked;
    answered.undecided = whole.result.undecided_states;
    count_(answered);
    if (batch.size() == 1)
    {
      batch.front().answer.set_value(std::move(whole));
      return;
    }
    std::size_t first = 0;
    for (CheckRequest& request : batch)
    {
      request.answer.set_value(part(whole, first, request));
      first += request.count;
    }
  }
  catch (...)
  {
    for (CheckRequest& request : batch)
      fail(request, std::current_exception());
  }
}

CheckAnswer CheckWorker::check(CheckBatch& batch, std::size_t count)
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
  if (std::any_of(batch.begin(), batch.end(), [](const CheckRequest& request) { return request.job.keep_states; }))
    answer.states = std::move(states);
  answer.device = checker_->deviceName();
  return answer;
}

/// Gives the checker the scene of the job and returns it.
Snapshot CheckWorker::takeScene(const CheckJob& job)
{
  Snapshot now = job.scene ? *job.scene : store_.snapshot();
  if (job.matrix)
  {
    auto other = std::make_shared<PlanningScene>(*now.scene);
    other->allowed_collisions = *job.matrix;
    other->matrix_source = MatrixSource::SceneFile;
    now.scene = std::move(other);
  }
  if (now.scene != checked_)
    giveScene(now.scene, !job.scene && !job.matrix);
  return now;
}

/// `is_own`: whether the scene is the service's own, and not one that a request has changed. If the own scene cannot be
/// checked either, or no device can be opened, this is not the fault of the request.
void CheckWorker::giveScene(const std::shared_ptr<const PlanningScene>& scene, bool is_own)
{
  try
  {
    if (checker_)
      checker_->setScene(scene);
    else
      checker_ = make_checker_(scene);
    checked_ = scene;
  }
  catch (...)
  {
    close();
    if (!is_own && takesOwnScene())
      throw;
    asFaultOfService([] { throw; });
  }
}

/// Makes the checker anew, with the service's own scene. Returns whether this was possible.
bool CheckWorker::takesOwnScene()
{
  try
  {
    giveScene(store_.snapshot().scene, true);
    return true;
  }
  catch (...)
  {
    return false;
  }
}

BatchResult CheckWorker::checkStates(const std::vector<double>& states, std::size_t count, const std::string& group)
{
  StateBatch batch{states.data(), count, group};
  batch.go_on = [this](std::size_t) { return !queue_.isStopping(); };
  try
  {
    return checker_->checkBatch(batch);
  }
  catch (const Cancelled&)
  {
    throw ShuttingDown();
  }
}

void CheckWorker::checkMotions(const CheckJob& job, const std::vector<double>& states, CheckAnswer& answer)
{
  const auto start = std::chrono::steady_clock::now();
  const MotionChecker checker(checker_, answer.scene->robot, job.group, *job.motions);
  const std::size_t width = answer.scene->robot->variables().size();
  const std::size_t rows = width == 0 ? 0 : states.size() / width;
  std::size_t count = rows / 2;
  const double* ends = states.data() + count * width;
  if (job.is_path)
  {
    answer.result = checkStates(states, rows, job.group);
    answer.states_checked = rows;
    count = rows == 0 ? 0 : rows - 1;
    ends = states.data() + (rows == 0 ? 0 : width);
  }
  else if (count == 0)
    checker_->check(nullptr, 0, job.group);  // the checker must see an unknown group even without motions
  answer.motions =
      checker.check(states.data(), ends, count, MotionQuery::LastValid, [this] { return queue_.isStopping(); });
  if (queue_.isStopping())
    throw ShuttingDown();
  answer.states_checked += checker.statesChecked();
  answer.result.revision = answer.scene->revision;
  answer.result.seconds = secondsSince(start);
}

/// Requests that already have an answer keep it.
void CheckWorker::fail(CheckRequest& request, std::exception_ptr error) const
{
  try
  {
    request.answer.set_exception(std::move(error));
  }
  catch (const std::future_error&)
  {
    return;
  }
  CheckStatistics failed;
  failed.errors = 1;
  count_(failed);
}
}  // namespace gpu_planning_scene::core
