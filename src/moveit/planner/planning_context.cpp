#include "moveit/planner/planning_context.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <utility>

#include <moveit/robot_state/conversions.h>
#include <ros/console.h>

#include "base/seconds_since.h"
#include "gpu_planning_scene/interpolation.h"
#include "moveit/planner/pose_constraints.h"
#include "moveit/planner/refusal.h"
#include "moveit/planner/request.h"

namespace gpu_planning_scene::pipeline
{
namespace
{
using Clock = std::chrono::steady_clock;
using Rows = std::vector<std::vector<double>>;

constexpr double kLeastSeconds = 1e-3;  // a plan with less time is not begun

std::vector<std::uint8_t> freeOf(core::StateChecker& checker, const Rows& rows, const std::string& group)
{
  std::vector<double> states;
  for (const std::vector<double>& row : rows)
    states.insert(states.end(), row.begin(), row.end());
  return checker.check(states.data(), rows.size(), group).valid;
}

/// The states that stand for the goals: the middle of each region; also random states of wide regions; and random
/// states instead of a middle that collides. If all states of a region collide, its middle stays, for the message.
Rows goalStates(const std::vector<GoalRegion>& regions, core::StateChecker& checker, const std::string& group)
{
  constexpr std::size_t kMaxStates = 1000;
  constexpr std::size_t kMaxSamples = 63;  // per region
  const std::size_t samples = std::min(kMaxSamples, kMaxStates / regions.size());
  Rows middles;
  for (const GoalRegion& region : regions)
    middles.push_back(region.middle());
  const std::vector<std::uint8_t> middle_free = freeOf(checker, middles, group);
  std::mt19937_64 random(std::random_device{}());
  Rows states = middles;
  for (std::size_t i = 0; i < regions.size(); ++i)
    if (middle_free[i] == 0 || regions[i].isWide())
      for (std::size_t k = 0; k < samples; ++k)
        states.push_back(regions[i].sample(random));
  return states;
}

double lengthOf(const core::RobotModel& robot, const Rows& waypoints)
{
  double length = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i)
    for (const core::JointTravel& travel : core::jointTravel(robot, waypoints[i - 1].data(), waypoints[i].data()))
      length += travel.angle + travel.length;
  return length;
}

std::int32_t codeOf(core::PlanningStatus status, bool in_time)
{
  switch (status)
  {
    case core::PlanningStatus::Solved:
      return MoveItErrorCodes::SUCCESS;
    case core::PlanningStatus::StartInCollision:
      return MoveItErrorCodes::START_STATE_IN_COLLISION;
    case core::PlanningStatus::GoalInCollision:
      return MoveItErrorCodes::GOAL_IN_COLLISION;
    case core::PlanningStatus::OutOfBounds:  // goals are within their limits
      return MoveItErrorCodes::START_STATE_INVALID;
    case core::PlanningStatus::GoalUnreachable:
      return MoveItErrorCodes::NO_IK_SOLUTION;
    case core::PlanningStatus::StartViolatesConstraints:
      return MoveItErrorCodes::START_STATE_VIOLATES_PATH_CONSTRAINTS;
    case core::PlanningStatus::GoalViolatesConstraints:
      return MoveItErrorCodes::GOAL_VIOLATES_PATH_CONSTRAINTS;
    case core::PlanningStatus::Approximate:
    case core::PlanningStatus::NoSolution:
      break;
  }
  return in_time ? MoveItErrorCodes::PLANNING_FAILED : MoveItErrorCodes::TIMED_OUT;
}
}  // namespace

struct PlanningContext::Outcome
{
  std::int32_t code = MoveItErrorCodes::FAILURE;
  std::string message;
  robot_trajectory::RobotTrajectoryPtr trajectory;
  moveit_msgs::RobotState start;
  double seconds = 0.0;
};

PlanningContext::PlanningContext(const std::string& group, PlannerChoice choice, std::shared_ptr<Workshop> workshop)
  : planning_interface::PlanningContext(choice.type, group), workshop_(std::move(workshop)), choice_(std::move(choice))
{
}

bool PlanningContext::terminate()
{
  stopped_ = true;
  return true;
}

PlanningContext::Outcome PlanningContext::plan()
{
  const Clock::time_point begin = Clock::now();
  stopped_ = false;
  Outcome outcome;
  try
  {
    outcome = planOrThrow();
  }
  catch (const Refusal& refusal)
  {
    outcome.code = refusal.code();
    outcome.message = refusal.what();
  }
  catch (const core::Error& error)  // of the scene or of the planner's parameters
  {
    outcome.code = MoveItErrorCodes::PLANNING_FAILED;
    outcome.message = error.what();
  }
  catch (const std::exception& error)
  {
    outcome.code = MoveItErrorCodes::FAILURE;
    outcome.message = std::string("the planner failed: ") + error.what();
  }
  outcome.seconds = core::secondsSince(begin);
  if (outcome.code != MoveItErrorCodes::SUCCESS)
    ROS_ERROR_STREAM_NAMED(kLogName, "Group '" << getGroupName() << "': " << outcome.message);
  return outcome;
}

PlanningContext::Outcome PlanningContext::planOrThrow()
{
  const Clock::time_point begin = Clock::now();
  const planning_scene::PlanningScene& scene = *getPlanningScene();
  const moveit::core::RobotModel& model = *scene.getRobotModel();
  requireSupported(request_, model);
  const moveit::core::JointModelGroup& group = *model.getJointModelGroup(getGroupName());
  const moveit::core::RobotState start = startOf(request_, scene);
  const ConvertedScene converted =
      workshop_->converter.convert(scene, start, group, workspaceOf(request_, scene, group));
  const core::GroupStateSpace space(converted.robot->robot(), getGroupName());
  core::PlanningQuery query = queryOf(space);
  query.start = converted.scene->current_state;
  std::vector<GoalRegion> regions;
  for (const moveit_msgs::Constraints& goal : request_.goal_constraints)
    if (isJointGoal(goal))
      regions.emplace_back(goal, model, *converted.robot, space, query.start);
    else
      query.goal_regions.push_back(kinematicConstraints(goal, scene, start, group, *converted.robot,
                                                        MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS, "the goal"));
  query.path_constraints = kinematicConstraints(request_.path_constraints, scene, start, group, *converted.robot,
                                                MoveItErrorCodes::PLANNING_FAILED, "the path constraints");

  core::CheckerPool::Lease lease(workshop_->checkers, converted.scene);
  if (!regions.empty())
    query.goals = goalStates(regions, *lease.checker(), getGroupName());
  query.seconds = request_.allowed_planning_time - core::secondsSince(begin);
  const bool has_time = query.seconds >= kLeastSeconds;
  core::PlanningResult result;
  if (has_time)
    result = planShortest(converted, lease.checker(), query);
  lease.giveBack();  // also without time: the next request uses what this one has prepared
  if (!has_time)
    throw Refusal(MoveItErrorCodes::TIMED_OUT,
                  "allowed_planning_time is " + std::to_string(request_.allowed_planning_time) +
                      " s; the conversion of the scene and the check of the goals took all of it");

  Outcome outcome;
  const bool in_time = core::secondsSince(begin) < request_.allowed_planning_time;
  outcome.code = codeOf(result.status, in_time);
  outcome.message = result.message;
  if (stopped_ && outcome.code != MoveItErrorCodes::SUCCESS)
  {
    outcome.code = MoveItErrorCodes::PREEMPTED;
    outcome.message = "planning was terminated";
  }
  moveit::core::robotStateToRobotStateMsg(start, outcome.start);
  if (outcome.code == MoveItErrorCodes::SUCCESS)
    outcome.trajectory = trajectoryOf(converted, result, start);
  return outcome;
}

core::PlanningQuery PlanningContext::queryOf(const core::GroupStateSpace& space) const
{
  core::PlanningQuery query;
  query.group = getGroupName();
  query.parameters = choice_.parameters;
  query.projection = choice_.projection;
  if (choice_.longest_valid_segment_fraction)
  {
    const double step = *choice_.longest_valid_segment_fraction * space.getMaximumExtent();
    query.motions.steps = {step, step};
  }
  return query;
}

/// Plans as often as the request asks, within its time. Returns the shortest path, or the last failure.
core::PlanningResult PlanningContext::planShortest(const ConvertedScene& converted,
                                                   const std::shared_ptr<core::StateChecker>& checker,
                                                   core::PlanningQuery query) const
{
  const Clock::time_point begin = Clock::now();
  const double seconds = query.seconds;
  const auto stop = [this] { return stopped_.load(); };
  core::PlanningResult best;
  double best_length = 0.0;
  for (int attempt = 0; attempt < std::max(1, request_.num_planning_attempts); ++attempt)
  {
    const double left = seconds - core::secondsSince(begin);
    if (attempt > 0 && (left < kLeastSeconds || stopped_))
      break;
    query.seconds = left;
    // Further attempts look for other paths.
    query.known_paths = attempt == 0 ? workshop_->known_paths : nullptr;
    core::PlanningResult result = core::planMotion(converted.scene, checker, query, *choice_.factory, stop);
    if (result.status != core::PlanningStatus::Solved)
    {
      if (best.status != core::PlanningStatus::Solved)
        best = std::move(result);
      if (best.status != core::PlanningStatus::Solved && best.status != core::PlanningStatus::NoSolution &&
          best.status != core::PlanningStatus::Approximate)
        break;
      continue;
    }
    const double length = lengthOf(*converted.robot->robot(), result.waypoints);
    if (best.status != core::PlanningStatus::Solved || length < best_length)
    {
      best = std::move(result);
      best_length = length;
    }
  }
  if (best.status == core::PlanningStatus::Solved)
    workshop_->known_paths->add(std::make_shared<core::GroupStateSpace>(converted.robot->robot(), query.group),
                                best.waypoints);
  return best;
}

/// The waypoints without times. Between them, MoveIt's controllers interpolate in other curves than straight lines,
/// and its checks are discrete, so long motions get waypoints in between.
robot_trajectory::RobotTrajectoryPtr PlanningContext::trajectoryOf(const ConvertedScene& converted,
                                                                   const core::PlanningResult& result,
                                                                   const moveit::core::RobotState& start) const
{
  const core::RobotModel& robot = *converted.robot->robot();
  auto trajectory = std::make_shared<robot_trajectory::RobotTrajectory>(start.getRobotModel(), getGroupName());
  moveit::core::RobotState state = start;
  const auto add = [&](const double* row)
  {
    converted.robot->setVariables(row, state);
    state.update();
    trajectory->addSuffixWayPoint(state, 0.0);
  };
  std::vector<double> between(robot.variables().size());
  for (std::size_t i = 0; i < result.waypoints.size(); ++i)
  {
    const double* const row = result.waypoints[i].data();
    const double* const before = i == 0 ? row : result.waypoints[i - 1].data();
    std::size_t parts = 1;
    if (choice_.waypoint_distance > 0.0)
      parts = static_cast<std::size_t>(
          core::segmentCount(robot, before, row, {choice_.waypoint_distance, choice_.waypoint_distance}));
    for (std::size_t part = 1; part < parts; ++part)
    {
      core::interpolate(robot, before, row, static_cast<double>(part) / static_cast<double>(parts), between.data());
      add(between.data());
    }
    add(row);
  }
  return trajectory;
}

bool PlanningContext::solve(planning_interface::MotionPlanResponse& response)
{
  const Outcome outcome = plan();
  response.trajectory_ = outcome.trajectory;
  response.planning_time_ = outcome.seconds;
  response.error_code_.val = outcome.code;
  response.start_state_ = outcome.start;
  response.planner_id_ = choice_.type;
  return outcome.code == MoveItErrorCodes::SUCCESS;
}

bool PlanningContext::solve(planning_interface::MotionPlanDetailedResponse& response)
{
  const Outcome outcome = plan();
  response.trajectory_.clear();
  response.description_.clear();
  response.processing_time_.clear();
  if (outcome.trajectory)
  {
    response.trajectory_.push_back(outcome.trajectory);
    response.description_.emplace_back("plan and simplify");
    response.processing_time_.push_back(outcome.seconds);
  }
  response.error_code_.val = outcome.code;
  response.start_state_ = outcome.start;
  response.planner_id_ = choice_.type;
  return outcome.code == MoveItErrorCodes::SUCCESS;
}
}  // namespace gpu_planning_scene::pipeline
