#include "gpu_planning_scene/planning/plan_motion.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning/motion_validator.h"
#include "gpu_planning_scene/planning/path_length_objective.h"
#include "gpu_planning_scene/planning/path_shortcutter.h"
#include "gpu_planning_scene/planning/state_validity_checker.h"
#include "collision/reach.h"
#include "planning/counted_checker.h"

namespace gpu_planning_scene
{
namespace
{
namespace ob = ompl::base;
namespace og = ompl::geometric;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void refuseRow(const RobotModel& robot, const std::vector<double>& row, const std::string& what)
{
  if (row.size() != robot.variables().size())
    throw Error(what + " has " + std::to_string(row.size()) + " values; the robot has " +
                std::to_string(robot.variables().size()) + " variables");
  for (std::size_t i = 0; i < row.size(); ++i)
    if (!std::isfinite(row[i]))
      throw Error(what + ": " + robot.variables()[i].name + " is " + std::to_string(row[i]) + "; it must be finite");
}

void refuse(const PlanningScene& scene, const PlanningQuery& query)
{
  refuseRow(*scene.robot, query.start, "the start");
  if (query.goals.empty())
    throw Error("there is no goal; give at least one");
  for (std::size_t i = 0; i < query.goals.size(); ++i)
    refuseRow(*scene.robot, query.goals[i], "goal " + std::to_string(i));
  if (!(query.seconds > 0.0) || !std::isfinite(query.seconds))
    throw Error("the planning time is " + std::to_string(query.seconds) + " s; it must be finite and above 0");
}

/// One query on its way.
class Plan
{
 public:
  Plan(const std::shared_ptr<const PlanningScene>& scene, const std::shared_ptr<StateChecker>& checker,
       const PlanningQuery& query, const std::function<bool()>& stop)
    : scene_(withStart(*scene, query)),
      checker_(std::make_shared<CountedChecker>(checker)),
      query_(query),
      stop_(stop),
      space_(std::make_shared<GroupStateSpace>(scene->robot, query.group)),
      information_(std::make_shared<ob::SpaceInformation>(space_)),
      start_(space_)
  {
    if (!query.projection.empty())
      space_->projectOnto(query.projection);
    information_->setStateValidityChecker(std::make_shared<StateValidityChecker>(information_, scene_, checker_));
    information_->setMotionValidator(std::make_shared<MotionValidator>(information_, scene_, checker_, query.motions));
    information_->setup();
    space_->copyFromRow(query.start.data(), start_.get());
  }

  PlanningResult run(const PlannerFactory& factory);

 private:
  /// The scene with the joints that are not planned for as they are at the start.
  static std::shared_ptr<const PlanningScene> withStart(const PlanningScene& scene, const PlanningQuery& query)
  {
    auto copy = std::make_shared<PlanningScene>(scene);
    copy->current_state = query.start;
    return copy;
  }

  bool findEnds(ob::GoalStates& goals);
  void setParameters(ob::Planner& planner) const;
  void simplify(og::PathGeometric& path);
  std::string outOfBounds(const std::vector<double>& row) const;
  std::string outsideOfProof() const;
  void takePath(og::PathGeometric& path);
  /// The pair of bodies that collides, in words; empty if the state is free.
  std::string collisionOf(const std::vector<double>& row);

  ob::PlannerTerminationCondition within(double seconds) const
  {
    const auto timed = ob::timedPlannerTerminationCondition(seconds);
    return stop_ ? ob::plannerOrTerminationCondition(timed, ob::PlannerTerminationCondition(stop_)) : timed;
  }

  std::shared_ptr<const PlanningScene> scene_;
  std::shared_ptr<CountedChecker> checker_;
  const PlanningQuery& query_;
  const std::function<bool()>& stop_;
  std::shared_ptr<GroupStateSpace> space_;
  ob::SpaceInformationPtr information_;
  ob::ScopedState<> start_;
  PlanningResult result_;
};

std::string Plan::outOfBounds(const std::vector<double>& row) const
{
  for (const int variable : space_->variables())
  {
    const Variable& limits = scene_->robot->variables()[static_cast<std::size_t>(variable)];
    const double value = row[static_cast<std::size_t>(variable)];
    if (limits.bounded && (value < limits.lower || value > limits.upper))
      return limits.name + " is " + std::to_string(value) + ", outside of " + std::to_string(limits.lower) + " to " +
             std::to_string(limits.upper);
  }
  ob::ScopedState<> state(space_);
  space_->copyFromRow(row.data(), state.get());
  return space_->satisfiesBounds(state.get()) ? "" : "a position is outside of the planning bounds";
}

/// Where a joint is beyond its limits, also one that is not planned for, no motion can be proven.
std::string Plan::outsideOfProof() const
{
  if (query_.motions.rule == MotionRule::Samples)
    return "";
  for (const VariableRange& range : limitRanges(*scene_->robot))
  {
    const auto variable = static_cast<std::size_t>(range.variable);
    const double value = query_.start[variable];
    if (value < range.lower || value > range.upper)
      return "the start is out of bounds: " + scene_->robot->variables()[variable].name + " is " +
             std::to_string(value) + ", beyond its limits, where no motion can be proven (motion rule bound)";
  }
  return "";
}

std::string Plan::collisionOf(const std::vector<double>& row)
{
  const BatchResult found = checker_->check(row.data(), 1, query_.group, nullptr);
  if (found.valid[0] != 0)
    return "";
  return scene_->bodyName(found.colliding[0][0]) + " and " + scene_->bodyName(found.colliding[0][1]);
}

/// False, with the status set, where there is nothing to plan between.
bool Plan::findEnds(ob::GoalStates& goals)
{
  const auto fail = [this](PlanningStatus status, const std::string& message)
  {
    result_.status = status;
    result_.message = message;
    return false;
  };
  if (const std::string wrong = outsideOfProof(); !wrong.empty())
    return fail(PlanningStatus::OutOfBounds, wrong);
  if (const std::string wrong = outOfBounds(query_.start); !wrong.empty())
    return fail(PlanningStatus::OutOfBounds, "the start is out of bounds: " + wrong);
  if (const std::string bodies = collisionOf(query_.start); !bodies.empty())
    return fail(PlanningStatus::StartInCollision, "the start is in collision: " + bodies);
  std::string first_wrong;
  PlanningStatus status = PlanningStatus::GoalsInCollision;  // what is wrong with the first one
  for (std::size_t i = 0; i < query_.goals.size(); ++i)
  {
    std::vector<double> row = query_.start;
    for (const int variable : space_->variables())
      row[static_cast<std::size_t>(variable)] = query_.goals[i][static_cast<std::size_t>(variable)];
    const std::string name = query_.goals.size() == 1 ? "the goal" : "goal " + std::to_string(i);
    const std::string beyond = outOfBounds(row);
    const std::string bodies = beyond.empty() ? collisionOf(row) : "";
    if (beyond.empty() && bodies.empty())
    {
      ob::ScopedState<> state(space_);
      space_->copyFromRow(row.data(), state.get());
      goals.addState(state);
    }
    else if (first_wrong.empty())
    {
      status = beyond.empty() ? PlanningStatus::GoalsInCollision : PlanningStatus::OutOfBounds;
      first_wrong = name + (beyond.empty() ? " is in collision: " + bodies : " is out of bounds: " + beyond);
    }
  }
  return goals.getStateCount() != 0 || fail(status, first_wrong);
}

void Plan::setParameters(ob::Planner& planner) const
{
  for (const auto& [name, value] : query_.parameters)
  {
    if (!planner.params().hasParam(name))
    {
      std::vector<std::string> names;
      planner.params().getParamNames(names);
      std::string all;
      for (const std::string& known : names)
        all += (all.empty() ? "" : ", ") + known;
      throw Error("planner " + planner.getName() + " has no parameter '" + name + "'; it has " +
                  (all.empty() ? "none" : all));
    }
    bool taken = false;
    try
    {
      taken = planner.params().setParam(name, value);
    }
    catch (const std::exception&)  // OMPL's, of a value that is no number
    {
    }
    if (!taken)
      throw Error("parameter " + name + " of planner " + planner.getName() + " cannot be '" + value + "'");
  }
}

void Plan::simplify(og::PathGeometric& path)
{
  const Clock::time_point start = Clock::now();
  const double left = std::max(0.1 * query_.seconds, query_.seconds - result_.planning_seconds);
  PathShortcutter(information_).shorten(path, within(left));
  result_.simplification_seconds = secondsSince(start);
}

/// Angles of continuous and planar joints go on from the start's as the motions do, without jumps by whole turns.
void Plan::takePath(og::PathGeometric& path)
{
  const RobotModel& robot = *scene_->robot;
  std::vector<double> last = query_.start;
  for (const ob::State* state : path.getStates())
  {
    std::vector<double> row = last;
    space_->copyToRow(state, row.data());
    for (const Joint& joint : robot.joints())
    {
      if (joint.mimic || (joint.type != JointType::Continuous && joint.type != JointType::Planar))
        continue;
      const auto angle = static_cast<std::size_t>(joint.first_variable + (joint.type == JointType::Planar ? 2 : 0));
      row[angle] = last[angle] + std::remainder(row[angle] - last[angle], 2.0 * EIGEN_PI);
    }
    result_.waypoints.push_back(row);
    last = std::move(row);
  }
}

PlanningResult Plan::run(const PlannerFactory& factory)
{
  const auto goals = std::make_shared<ob::GoalStates>(information_);
  if (findEnds(*goals))
  {
    const auto definition = std::make_shared<ob::ProblemDefinition>(information_);
    definition->addStartState(start_);
    definition->setGoal(goals);
    definition->setOptimizationObjective(std::make_shared<PathLengthObjective>(information_));
    const ob::PlannerPtr planner = factory.create(information_);
    setParameters(*planner);
    planner->setProblemDefinition(definition);
    planner->setup();
    const Clock::time_point start = Clock::now();
    const ob::PlannerStatus status = planner->solve(within(query_.seconds));
    result_.planning_seconds = secondsSince(start);
    const bool exact = status == ob::PlannerStatus::EXACT_SOLUTION;
    result_.status = exact ? PlanningStatus::Solved : PlanningStatus::NoSolution;
    if (!exact)
      result_.message = "no solution within " + std::to_string(query_.seconds) + " s (" + planner->getName() + ": " +
                        status.asString() + ")";
    if (definition->hasSolution())
    {
      auto path = *definition->getSolutionPath()->as<og::PathGeometric>();
      if (!exact)
      {
        result_.status = PlanningStatus::Approximate;
        result_.message += "; the path ends " + std::to_string(definition->getSolutionDifference()) + " from a goal";
      }
      if (query_.simplify)
        simplify(path);
      takePath(path);
    }
  }
  result_.checking_seconds = checker_->seconds();
  result_.states_checked = checker_->states();
  result_.revision = scene_->revision;
  return std::move(result_);
}
}  // namespace

PlanningResult planMotion(const std::shared_ptr<const PlanningScene>& scene,
                          const std::shared_ptr<StateChecker>& checker, const PlanningQuery& query,
                          const PlannerFactory& factory, const std::function<bool()>& stop)
{
  refuse(*scene, query);
  try
  {
    return Plan(scene, checker, query, stop).run(factory);
  }
  catch (const ompl::Exception& error)
  {
    throw Error(error.what());
  }
}
}  // namespace gpu_planning_scene
