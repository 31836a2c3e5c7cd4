#include "node/planning/plan_service.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <ros/console.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "node/checks/requested_scene.h"
#include "node/endpoints/respond.h"
#include "node/messages/requested_timing.h"
#include "node/messages/trajectory_messages.h"
#include "node/planning/rehearsal.h"
#include "node/planning/requested_goals.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
using Response = PlanMotion::Response;

std::uint8_t statusOf(PlanningStatus status)
{
  switch (status)
  {
    case PlanningStatus::Solved:
      return AnswerStatus::OK;
    case PlanningStatus::Approximate:
      return Response::APPROXIMATE;
    case PlanningStatus::NoSolution:
      return Response::NO_SOLUTION;
    case PlanningStatus::StartInCollision:
      return Response::START_IN_COLLISION;
    case PlanningStatus::GoalInCollision:
      return Response::GOAL_IN_COLLISION;
    case PlanningStatus::OutOfBounds:
      return Response::OUT_OF_BOUNDS;
    case PlanningStatus::GoalUnreachable:
      return Response::GOAL_UNREACHABLE;
    case PlanningStatus::StartViolatesConstraints:
      return Response::START_VIOLATES_CONSTRAINTS;
    case PlanningStatus::GoalViolatesConstraints:
      return Response::GOAL_VIOLATES_CONSTRAINTS;
  }
  return AnswerStatus::INTERNAL_ERROR;
}
}  // namespace

PlanService::PlanService(ros::NodeHandle& own, const SceneStore& store, OtherFrames others, MakeChecker make_checker,
                         const MemoryGuard& memory, Show show, const PlanServiceOptions& options)
  : store_(store),
    others_(std::move(others)),
    memory_(memory),
    show_(std::move(show)),
    options_(options),
    known_paths_(std::make_shared<KnownPaths>(options.known_paths)),
    configs_(PlannerConfigs::fromParameters(own)),
    admission_(options.at_once, options.max_waiting),
    checkers_(std::move(make_checker))
{
}

void PlanService::prepare()
{
  const std::shared_ptr<const PlanningScene> scene = store_.snapshot().scene;
  if (scene->robot->groups().empty())
    return;
  for (const Group& group : scene->robot->groups())
    try
    {
      plugins_.find(configs_.find("", group.name).type, configs_.names());
    }
    catch (const std::exception& error)
    {
      ROS_DEBUG_STREAM("the planner of group '" << group.name << "' is not prepared: " << error.what());
    }
  try
  {
    // Rehearsals use the batch planner, also for groups that have another one, because others may exceed their time.
    const std::shared_ptr<const PlannerFactory> batch_planner = plugins_.find(kBatchPlanner, {});
    CheckerPool::Lease lease(checkers_, scene);
    rehearsePlans(scene, lease.checker(), options_.motions, *batch_planner, [this] { return stopping_ || !ros::ok(); });
    lease.giveBack();
  }
  catch (const std::exception& error)
  {
    ROS_DEBUG_STREAM("plans are not prepared: " << error.what());
  }
}

void PlanService::stop()
{
  stopping_ = true;
  admission_.stop();
}

PlanMotion::Response PlanService::plan(const PlanMotion::Request& request)
{
  return respond<Response>([&](Response& response) { return fill(request, response); });
}

/// A planner that the request does not name is named in ~planners, so the request is not the cause of its errors.
std::shared_ptr<const PlannerFactory> PlanService::factoryOf(const PlannerConfig& config, const std::string& requested)
{
  try
  {
    return plugins_.find(config.type, configs_.names());
  }
  catch (const Error& error)
  {
    if (!requested.empty() && configs_.configs().count(requested) == 0)
      throw;
    throw InternalError(std::string("~planners: ") + error.what());
  }
}

PlanService::Task PlanService::taskOf(const PlanMotion::Request& request)
{
  const PlannerConfig config = configs_.find(request.planner, request.group);
  const std::shared_ptr<const PlannerFactory> factory = factoryOf(config, request.planner);
  RequestedScene requested = requestedScene(store_, others_.pose, request.scene_diff, {});
  const Snapshot& now = requested.now;
  const RequestedState start = requestedStart(request, now);
  PlanningQuery query = queryFrom(request, now, start, config, configs_.ofGroup(request.group), options_);
  query.known_paths = known_paths_;
  addRegions(request, *now.scene, others_, options_.max_goals, query);
  std::vector<std::string> warnings = std::move(requested.warnings);
  for (std::string& warning : planWarnings(request, now, start))
    warnings.push_back(std::move(warning));
  const auto timing =
      requestedTiming(request, *now.scene->robot, options_.max_deviation, query.motions, query.path_constraints);
  return {now.scene, !requested.is_changed, std::move(query), timing, factory, config.type, std::move(warnings)};
}

PlanService::Answer PlanService::plan(const Task& task)
{
  CheckerPool::Lease lease(checkers_, task.scene, task.is_own_scene);
  const auto stop = [this] { return stopping_.load(); };
  try
  {
    Answer answer{planMotion(task.scene, lease.checker(), task.query, *task.factory, stop), {}};
    if (answer.plan.status == PlanningStatus::Solved)
      known_paths_->add(std::make_shared<GroupStateSpace>(task.scene->robot, task.query.group, task.query.workspace),
                        answer.plan.waypoints);
    if (task.timing && !answer.plan.waypoints.empty())
      answer.timed =
          timePath(*task.scene, lease.checker(), task.query.group, answer.plan.waypoints, *task.timing, stop);
    lease.giveBack();
    return answer;
  }
  catch (const Error&)
  {
    lease.giveBack();  // the checker is not the cause of the error: it has no device that could be lost
    throw;
  }
}

std::uint8_t PlanService::fill(const PlanMotion::Request& request, PlanMotion::Response& response)
{
  memory_.require();
  const Admission::Pass pass(admission_);
  const Task task = taskOf(request);
  Answer answer = plan(task);
  const PlanningResult& result = answer.plan;
  if (stopping_)
    throw ShuttingDown();
  const Group& group = task.scene->robot->group(request.group);
  const std::uint8_t status = statusOf(result.status);
  response.message = result.message;
  addWarnings(task.warnings, response.message);
  response.trajectory =
      trajectoryOf(*task.scene->robot, group, result.waypoints, answer.timed ? &*answer.timed : nullptr);
  response.planner = task.planner;
  response.planning_time = result.planning_seconds;
  response.simplification_time = result.simplification_seconds;
  response.checking_time = result.checking_seconds;
  response.states_checked = result.states_checked;
  response.scene_revision = result.revision;
  if (answer.timed)
  {
    addWarning(answer.timed->message, response.message);
    response.planning_time += answer.timed->seconds;
    response.checking_time += answer.timed->checking_seconds;
    response.states_checked += answer.timed->states_checked;
  }
  show_(std::make_shared<const ShownPlan>(ShownPlan{task.scene, group, task.query.start, task.query.goal_regions,
                                                    result.status, result.message, std::move(answer.plan.waypoints),
                                                    std::move(answer.timed)}));
  return status;
}
}  // namespace gpu_planning_scene::core
