#include "service/check_server.h"

#include "service/check_queue.h"

namespace gpu_planning_scene::core
{
namespace
{
// The largest matrix of a small request. To compare it, to copy it and to sort the pairs again takes no longer than a
// check.
constexpr std::size_t kBodiesOfSmallMatrix = 100;

// Small requests are merged up to the states of so many of the largest ones. Each of them waits for all.
constexpr std::size_t kMergedRequests = 16;

bool isSmall(const CheckJob& job, const SceneStore& store)
{
  const bool has_other_scene = job.scene && job.scene->scene != store.snapshot().scene;
  return !has_other_scene && (!job.matrix || job.matrix->bodies().size() <= kBodiesOfSmallMatrix);
}
}  // namespace

CheckStatistics& CheckStatistics::operator+=(const CheckStatistics& other)
{
  requests += other.requests;
  batches += other.batches;
  states += other.states;
  undecided += other.undecided;
  busy += other.busy;
  errors += other.errors;
  waiting_requests += other.waiting_requests;
  waiting_states += other.waiting_states;
  return *this;
}

CheckServer::CheckServer(const SceneStore& store, const MakeChecker& make_checker, const CheckServerOptions& options,
                         const MakeChecker& make_relief)
  : store_(store),
    options_(options),
    width_(store.snapshot().scene->robot->variables().size()),
    small_(std::make_unique<CheckQueue>(store, make_checker, options, kMergedRequests * options.small_request,
                                        make_relief)),
    large_(std::make_unique<CheckQueue>(store, make_checker, options, 0))
{
  small_->open();
}

CheckServer::~CheckServer() = default;

void CheckServer::requireStateCount(std::size_t count) const
{
  if (count > options_.max_states)
    throw Error(std::to_string(count) + " states in one request; the limit is " + std::to_string(options_.max_states) +
                " (limits/request_states): send fewer states per request");
}

std::future<CheckAnswer> CheckServer::submit(CheckJob job)
{
  const std::size_t width = job.columns.empty() ? width_ : job.columns.size();
  if (width == 0 ? !job.states.empty() : job.states.size() % width != 0)
    throw Error(std::to_string(job.states.size()) + " values do not make rows of " + std::to_string(width) +
                " variables");
  const std::size_t rows = width == 0 ? 0 : job.states.size() / width;
  if (job.motions && !job.is_path && rows % 2 != 0)
    throw Error(std::to_string(rows) + " states: motions need as many ends as starts");
  const std::size_t count = job.motions ? job.samples : rows;
  requireStateCount(count);
  CheckQueue& queue = count <= options_.small_request && isSmall(job, store_) ? *small_ : *large_;
  return queue.submit(std::move(job), count);
}

void CheckServer::stop()
{
  small_->refuse();
  large_->refuse();
  small_->stop();
  large_->stop();
}

CheckStatistics CheckServer::statistics() const
{
  CheckStatistics sum = small_->statistics();
  return sum += large_->statistics();
}
}  // namespace gpu_planning_scene::core
