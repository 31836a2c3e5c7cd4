#include "service/check_server.h"

#include "service/check_lane.h"

namespace gpu_planning_scene
{
CheckServer::CheckServer(const SceneStore& store, MakeChecker make_checker, const CheckServerOptions& options)
  : options_(options),
    small_(std::make_unique<CheckLane>(store, make_checker, options, options.largest_batch)),
    large_(std::make_unique<CheckLane>(store, make_checker, options, 0))
{
  small_->open();
}

CheckServer::~CheckServer() = default;

std::future<CheckAnswer> CheckServer::submit(CheckJob job)
{
  const std::size_t width = small_->stateWidth();
  if (width == 0 ? !job.states.empty() : job.states.size() % width != 0)
    throw Error(std::to_string(job.states.size()) + " numbers are not rows of " + std::to_string(width) + " variables");
  const std::size_t count = width == 0 ? 0 : job.states.size() / width;
  if (count > options_.most_states)
    throw Error(std::to_string(count) + " states in one request; the limit is " + std::to_string(options_.most_states) +
                " (limits/request_states): send fewer at once");
  CheckLane& lane = count <= options_.small_request ? *small_ : *large_;
  return lane.submit(std::move(job), count);
}

void CheckServer::stop()
{
  small_->stop();
  large_->stop();
}

CheckStatistics CheckServer::statistics() const
{
  CheckStatistics sum = small_->statistics();
  const CheckStatistics large = large_->statistics();
  sum.requests += large.requests;
  sum.batches += large.batches;
  sum.states += large.states;
  sum.undecided += large.undecided;
  sum.busy += large.busy;
  sum.errors += large.errors;
  sum.waiting_requests += large.waiting_requests;
  sum.waiting_states += large.waiting_states;
  return sum;
}
}  // namespace gpu_planning_scene
