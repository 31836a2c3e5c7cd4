#include "node/plan_service.h"

#include <algorithm>
#include <set>
#include <utility>

#include <visualization_msgs/MarkerArray.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "model/full_states.h"
#include "node/answered.h"
#include "node/parameter_values.h"
#include "node/path_markers.h"
#include "node/requested_states.h"
#include "service/busy.h"

namespace gpu_planning_scene
{
namespace
{
using Response = PlanMotion::Response;

std::uint8_t statusOf(PlanningStatus status)
{
  switch (status)
  {
    case PlanningStatus::Solved:
      return Response::SOLVED;
    case PlanningStatus::Approximate:
      return Response::APPROXIMATE;
    case PlanningStatus::NoSolution:
      return Response::NO_SOLUTION;
    case PlanningStatus::StartInCollision:
      return Response::START_IN_COLLISION;
    case PlanningStatus::GoalsInCollision:
      return Response::GOAL_IN_COLLISION;
    case PlanningStatus::OutOfBounds:
      return Response::OUT_OF_BOUNDS;
  }
  return Response::BAD_REQUEST;
}

/// Only what the group plans for can be a goal.
void requirePlannedFor(const std::vector<int>& columns, const GroupStateSpace& space)
{
  for (const int column : columns)
    if (std::find(space.variables().begin(), space.variables().end(), column) == space.variables().end())
      throw Error("goal_names has " + space.robot()->variables()[static_cast<std::size_t>(column)].name +
                  ", which group '" + space.group().name + "' does not plan for");
}

trajectory_msgs::JointTrajectory trajectoryOf(const PlanningScene& scene, const PlanningResult& result,
                                              const Group& group)
{
  trajectory_msgs::JointTrajectory trajectory;
  trajectory.header.frame_id = scene.robot->planningFrame();
  for (const int variable : group.variables)
    trajectory.joint_names.push_back(scene.robot->variables()[static_cast<std::size_t>(variable)].name);
  for (const std::vector<double>& row : result.waypoints)
  {
    trajectory_msgs::JointTrajectoryPoint point;
    for (const int variable : group.variables)
      point.positions.push_back(row[static_cast<std::size_t>(variable)]);
    trajectory.points.push_back(std::move(point));
  }
  return trajectory;
}
}  // namespace

PlanServiceOptions planOptionsFromParameters(const ros::NodeHandle& own)
{
  constexpr std::size_t kMostAtOnce = 64;
  constexpr std::size_t kNoLimit = std::size_t{1} << 31;
  PlanServiceOptions options;
  options.seconds = positiveParameter(own, "planning/time", options.seconds);
  options.most_seconds = positiveParameter(own, "limits/planning_time", options.most_seconds);
  const std::string rule = textParameter(own, "planning/motion_rule", "bound");
  try
  {
    options.motions.rule = motionRuleFromName(rule);
  }
  catch (const Error& error)
  {
    throw Error("parameter " + own.resolveName("planning/motion_rule") + ": " + error.what());
  }
  MotionSteps& steps = options.motions.steps;
  steps.revolute = positiveParameter(own, "planning/resolution", steps.revolute);
  steps.prismatic = positiveParameter(own, "planning/translation_resolution", steps.prismatic);
  options.at_once = countParameter(own, "planning/at_once", options.at_once, 1, kMostAtOnce);
  options.most_waiting = countParameter(own, "limits/waiting_plans", options.most_waiting, 0, kNoLimit);
  options.most_goals = countParameter(own, "limits/goals", options.most_goals, 1, kNoLimit);
  return options;
}

/// A checker with the scene, for as long as one request is planned for. One that throws is not used again.
class PlanService::CheckerLease
{
 public:
  CheckerLease(PlanService& service, const std::shared_ptr<const PlanningScene>& scene) : service_(service)
  {
    {
      const std::lock_guard<std::mutex> lock(service_.mutex_);
      if (!service_.idle_.empty())
      {
        checker_ = std::move(service_.idle_.back());
        service_.idle_.pop_back();
      }
    }
    if (checker_)
      checker_->setScene(scene);
    else
      checker_ = service_.make_checker_(scene);
  }

  void giveBack()
  {
    const std::lock_guard<std::mutex> lock(service_.mutex_);
    service_.idle_.push_back(std::move(checker_));
  }

  const std::shared_ptr<StateChecker>& checker() const { return checker_; }

 private:
  PlanService& service_;
  std::shared_ptr<StateChecker> checker_;
};

PlanService::PlanService(ros::NodeHandle& own, const SceneStore& store, CheckServer::MakeChecker make_checker,
                         const MemoryGuard& memory, const PlanServiceOptions& options)
  : store_(store),
    make_checker_(std::move(make_checker)),
    memory_(memory),
    options_(options),
    configs_(PlannerConfigs::fromParameters(own)),
    markers_(own.advertise<visualization_msgs::MarkerArray>("plan_markers", 1, true)),
    admission_(options.at_once, options.most_waiting)
{
}

void PlanService::stop()
{
  stopping_ = true;
  admission_.stop();
}

PlanMotion::Response PlanService::plan(const PlanMotion::Request& request)
{
  bool busy = false;
  auto response = answered<Response>(
      [&](Response& filled)
      {
        try
        {
          fill(request, filled);
        }
        catch (const Busy&)
        {
          busy = true;
          throw;
        }
      });
  if (!response.success)
    response.status = busy ? Response::BUSY : Response::BAD_REQUEST;
  else
    response.success = response.status == Response::SOLVED;
  return response;
}

void PlanService::fill(const PlanMotion::Request& request, PlanMotion::Response& response)
{
  memory_.require();
  const Admission::Pass pass(admission_);
  const PlannerConfig config = configs_.find(request.planner, request.group);
  const std::shared_ptr<const PlannerFactory> factory = plugins_.find(config.type);
  const Snapshot now = store_.snapshot();
  const PlanningQuery query = queryFrom(request, now, config);
  CheckerLease lease(*this, now.scene);
  const PlanningResult result =
      planMotion(now.scene, lease.checker(), query, *factory, [this] { return stopping_.load(); });
  lease.giveBack();
  if (stopping_)
    throw Error("shutting down: the request was not answered");
  const Group& group = now.scene->robot->group(request.group);
  response.status = statusOf(result.status);
  response.message = result.message;
  response.trajectory = trajectoryOf(*now.scene, result, group);
  response.planner = config.type;
  response.planning_time = result.planning_seconds;
  response.simplification_time = result.simplification_seconds;
  response.checking_time = result.checking_seconds;
  response.states_checked = result.states_checked;
  response.scene_revision = result.revision;
  markers_.publish(pathMarkers(*now.scene, result.waypoints, group));
}

PlanningQuery PlanService::queryFrom(const PlanMotion::Request& request, const Snapshot& now,
                                     const PlannerConfig& config) const
{
  const RobotModel& robot = *now.scene->robot;
  PlanningQuery query;
  query.group = request.group;
  const auto one = [](std::size_t count)
  {
    if (count > 1)
      throw Error("start has " + std::to_string(count) + " rows; a motion has one start");
  };
  const PartialState current = now.partialState();
  if (request.start_names.empty() && request.start.empty())
    query.start = fullStates(robot, {}, nullptr, 1, current);
  else
  {
    const std::vector<int> columns = requestedColumns(robot, request.start_names, request.start, "start", one);
    query.start = fullStates(robot, columns, request.start.data(), 1, current);
  }
  const auto few = [this](std::size_t count)
  {
    if (count > options_.most_goals)
      throw Error(std::to_string(count) + " goals are more than " + std::to_string(options_.most_goals) +
                  " (limits/goals)");
  };
  const std::vector<int> columns = requestedColumns(robot, request.goal_names, request.goals, "goals", few);
  const GroupStateSpace space(now.scene->robot, request.group);
  requirePlannedFor(columns, space);
  const std::size_t width = columns.size();
  const PartialState start(robot, query.start);
  const std::size_t goals = request.goals.size() / width;
  const std::vector<double> rows = fullStates(robot, columns, request.goals.data(), goals, start);
  for (std::size_t i = 0; i < goals; ++i)
    query.goals.emplace_back(rows.begin() + static_cast<std::ptrdiff_t>(i * query.start.size()),
                             rows.begin() + static_cast<std::ptrdiff_t>((i + 1) * query.start.size()));

  query.seconds = request.allowed_planning_time == 0.0 ? options_.seconds : request.allowed_planning_time;
  if (query.seconds > options_.most_seconds)
    throw Error("allowed_planning_time is " + std::to_string(query.seconds) + " s; the limit is " +
                std::to_string(options_.most_seconds) + " (limits/planning_time)");
  query.simplify = request.simplify;
  query.motions = options_.motions;
  if (!request.motion_rule.empty())
    query.motions.rule = motionRuleFromName(request.motion_rule);
  if (const auto& fraction = configs_.ofGroup(request.group).longest_valid_segment_fraction)
  {
    const double step = *fraction * space.getMaximumExtent();
    query.motions.steps = {step, step};
  }
  if (request.resolution != 0.0)
    query.motions.steps.revolute = request.resolution;
  if (request.translation_resolution != 0.0)
    query.motions.steps.prismatic = request.translation_resolution;
  query.parameters = config.parameters;
  std::set<std::string> given;
  for (const auto& parameter : request.parameters)
  {
    if (!given.insert(parameter.key).second)
      throw Error("parameter '" + parameter.key + "' is given twice");
    query.parameters[parameter.key] = parameter.value;
  }
  query.projection = configs_.ofGroup(request.group).projection;
  return query;
}
}  // namespace gpu_planning_scene
