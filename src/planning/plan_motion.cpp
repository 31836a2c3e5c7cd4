#include "gpu_planning_scene/planning/plan_motion.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <random>
#include <string>
#include <utility>

#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "base/seconds_since.h"
#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning/motion_validator.h"
#include "gpu_planning_scene/planning/path_length_objective.h"
#include "gpu_planning_scene/planning/path_optimizer.h"
#include "gpu_planning_scene/planning/path_shortcutter.h"
#include "gpu_planning_scene/planning/state_validity_checker.h"
#include "model/full_states.h"
#include "planning/goals/checked_endpoints.h"
#include "planning/goals/goal_regions.h"
#include "planning/planner_parameters.h"
#include "planning/space/valid_row.h"
#include "planning/space/waypoints.h"
#include "planning/validity/counted_checker.h"

// The planner gets the time that the check of the start and the goals leaves. Simplification and the last check of the
// path may then each take the time that is left, but at least a tenth of the planning time. Own method.
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
namespace og = ompl::geometric;
using Clock = std::chrono::steady_clock;

void validateQuery(const PlanningScene& scene, const PlanningQuery& query)
{
  validateRow(*scene.robot, query.start, "the start");
  if (query.goals.empty() && query.goal_regions.empty())
    throw Error("there is no goal; give at least one");
  for (std::size_t i = 0; i < query.goals.size(); ++i)
    validateRow(*scene.robot, query.goals[i], "goal " + std::to_string(i));
  for (std::size_t i = 0; i < query.goal_regions.size(); ++i)
  {
    query.goal_regions[i].validate(*scene.robot, "goal region " + std::to_string(i));
    if (query.goal_regions[i].isEmpty())
      throw Error("goal region " + std::to_string(i) + " has no constraint; give at least one");
  }
  query.path_constraints.validate(*scene.robot, "the path constraints");
  constexpr double kMaxSeconds = 1e9;  // OMPL's clock counts nanoseconds in integers
  if (!(query.seconds > 0.0 && query.seconds <= kMaxSeconds))
    throw Error("the planning time is " + std::to_string(query.seconds) + " s; it must be above 0 and at most 1e9");
  if (!(query.optimize_seconds >= 0.0 && query.optimize_seconds <= kMaxSeconds))
    throw Error("the time to optimize is " + std::to_string(query.optimize_seconds) +
                " s; it must be at least 0 and at most 1e9");
}

/// Refuses goals that no motion of the group reaches, because they move other variables.
void requireMotionOfGroup(const GroupStateSpace& space, const PlanningQuery& query)
{
  const RobotModel& robot = *space.robot();
  for (std::size_t i = 0; i < query.goals.size(); ++i)
    if (const int moved = movedVariableBeyond(robot, space.variables(), query.start.data(), query.goals[i].data());
        moved >= 0)
    {
      const auto variable = static_cast<std::size_t>(moved);
      throw Error("goal " + std::to_string(i) + ": " + robot.variables()[variable].name + " is " +
                  numberText(query.goals[i][variable]) + " and at the start " + numberText(query.start[variable]) +
                  ", but group '" + query.group + "' does not plan for it; give it the value of the start");
    }
}

/// The goal regions, with the path constraints, within the ranges of the space.
std::vector<KinematicConstraints> regionsOf(const PlanningQuery& query, const GroupStateSpace& space)
{
  const RobotModel& robot = *space.robot();
  std::vector<KinematicConstraints> regions = query.goal_regions;
  for (KinematicConstraints& region : regions)
  {
    region.append(query.path_constraints);
    for (std::size_t i = 0; query.workspace && i < space.variables().size(); ++i)
      if (const auto [lower, upper] = space.ranges()[i]; std::isfinite(lower) && std::isfinite(upper))
        region.addJoint(robot, space.variables()[i], lower, upper);
  }
  return regions;
}

std::string seconds(double value)
{
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.3g s", value);
  return text.data();
}

/// Seeds the generator from which all of OMPL's random generators get their seeds. It belongs to the process, so the
/// returned lock is held for as long as the plan creates generators.
std::unique_lock<std::mutex> seeded(std::uint32_t seed)
{
  static std::mutex mutex;
  if (seed == 0)
    return {};
  std::unique_lock<std::mutex> lock(mutex);
  const auto level = ompl::msg::getLogLevel();
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);  // OMPL warns about every seed after the first one
  ompl::RNG::setSeed(seed);
  ompl::msg::setLogLevel(level);
  return lock;
}

/// The work on one query.
class Plan
{
 public:
  Plan(const std::shared_ptr<const PlanningScene>& scene, const std::shared_ptr<StateChecker>& checker,
       const PlanningQuery& query, const std::function<bool()>& stop)
    : scene_(withStart(*scene, query)),
      checker_(std::make_shared<CountedChecker>(checker)),
      query_(query),
      stop_(stop),
      space_(std::make_shared<GroupStateSpace>(scene->robot, query.group, query.workspace)),
      information_(std::make_shared<ob::SpaceInformation>(space_)),
      start_(space_)
  {
    requireMotionOfGroup(*space_, query);
    if (!query.projection.empty())
      space_->projectOnto(query.projection);
    information_->setStateValidityChecker(std::make_shared<StateValidityChecker>(information_, scene_, checker_));
    validator_ = std::make_shared<MotionValidator>(information_, scene_, checker_, query.motions);
    validator_->rememberValidMotions();
    if (!query.path_constraints.isEmpty())
      constraints_ = std::make_shared<const PathConstraints>(scene->robot, query.group, query.path_constraints);
    validator_->constrain(constraints_);
    information_->setMotionValidator(validator_);
    information_->setup();
    space_->copyFromRow(query.start.data(), start_.get());
  }

  PlanningResult run(const PlannerFactory& factory);

 private:
  /// A copy of the scene whose current state is the start, so that the joints outside the group keep the values of
  /// the start.
  static std::shared_ptr<const PlanningScene> withStart(const PlanningScene& scene, const PlanningQuery& query)
  {
    auto copy = std::make_shared<PlanningScene>(scene);
    copy->current_state = query.start;
    return copy;
  }

  ob::GoalPtr goalOf(const CheckedEndpoints& endpoints);
  void findPath(const PlannerFactory& factory, const ob::GoalPtr& goals);
  std::vector<og::PathGeometric> knownPaths() const;
  std::string faultOf(const og::PathGeometric* path, const ob::Goal* goals) const;
  void finish(og::PathGeometric& path, const ob::GoalPtr& goals, const std::string& planner);

  /// Why the planner had little time, for a message. Empty if it had most of the query's time.
  std::string reasonOfDelay() const
  {
    if (endpoint_seconds_ < 0.5 * query_.seconds)
      return "";
    return "; checking the start and the goals took " + seconds(endpoint_seconds_) +
           " of this time, because the first checks in a scene prepare the later ones, or the machine is busy";
  }

  ob::PlannerTerminationCondition within(double seconds) const
  {
    const auto timed = ob::timedPlannerTerminationCondition(seconds);
    return stop_ ? ob::plannerOrTerminationCondition(timed, ob::PlannerTerminationCondition(stop_)) : timed;
  }

  const Clock::time_point begin_ = Clock::now();
  double endpoint_seconds_ = 0.0;  // of checking the start and the goals
  std::shared_ptr<const PlanningScene> scene_;
  std::shared_ptr<CountedChecker> checker_;
  const PlanningQuery& query_;
  const std::function<bool()>& stop_;
  std::shared_ptr<GroupStateSpace> space_;
  ob::SpaceInformationPtr information_;
  std::shared_ptr<MotionValidator> validator_;
  std::shared_ptr<const PathConstraints> constraints_;  // null: none
  ob::ScopedState<> start_;
  PlanningResult result_;
};

/// The fault of a planner's path, in words. Empty if the path begins at the start and, if `goals` is given, ends at one
/// of the goals.
std::string Plan::faultOf(const og::PathGeometric* path, const ob::Goal* goals) const
{
  if (!path || path->getStateCount() == 0)
    return "no path";
  if (!space_->equalStates(path->getState(0), start_.get()))
    return "a path that does not begin at the start";
  if (goals && !goals->isSatisfied(path->getState(static_cast<unsigned int>(path->getStateCount() - 1))))
    return "a path that does not end at a goal";
  return "";
}

/// The known paths of the query, in the planner's space.
std::vector<og::PathGeometric> Plan::knownPaths() const
{
  std::vector<og::PathGeometric> paths;
  ob::ScopedState<> state(space_);
  std::vector<double> row = query_.start;
  for (const std::shared_ptr<const KnownPaths::Path>& known : query_.known_paths->of(query_.group))
  {
    if (known->front().size() != space_->variables().size())
      continue;  // of another robot
    paths.emplace_back(information_);
    for (const std::vector<double>& values : *known)
    {
      for (std::size_t i = 0; i < values.size(); ++i)
        row[static_cast<std::size_t>(space_->variables()[i])] = values[i];
      space_->copyFromRow(row.data(), state.get());
      paths.back().append(state.get());
    }
  }
  return paths;
}

/// The goal for the planner. Null, with the fault in the result, if there is no goal state and no state of a goal
/// region is found.
ob::GoalPtr Plan::goalOf(const CheckedEndpoints& endpoints)
{
  if (query_.goal_regions.empty())
  {
    const auto goals = std::make_shared<ob::GoalStates>(information_);
    for (const ob::ScopedState<>& goal : endpoints.goals)
      goals->addState(goal);
    return goals;
  }
  const std::uint64_t seed = query_.seed != 0 ? query_.seed : std::random_device{}();
  const auto goals = std::make_shared<GoalRegions>(information_, scene_, checker_, regionsOf(query_, *space_),
                                                   query_.start, endpoints.goals, seed);
  if (goals->prepare(within(query_.seconds - secondsSince(begin_))))
    return goals;
  bool in_collision = false;
  const std::string& beside = endpoints.fault_beside_regions;
  result_.message =
      beside + (beside.empty() ? "" : "; ") + goals->fault(beside.empty() ? "goal" : "goal region", in_collision);
  result_.status = in_collision ? PlanningStatus::GoalInCollision : PlanningStatus::GoalUnreachable;
  return nullptr;
}

/// Plans. The time of the query counts from the beginning of the call.
void Plan::findPath(const PlannerFactory& factory, const ob::GoalPtr& goals)
{
  const auto definition = std::make_shared<ob::ProblemDefinition>(information_);
  definition->addStartState(start_);
  definition->setGoal(goals);
  definition->setOptimizationObjective(std::make_shared<PathLengthObjective>(information_));
  const ob::PlannerPtr planner = factory.create(information_);
  setParameters(*planner, query_.parameters);
  if (query_.seed != 0 && planner->params().hasParam("searches") && query_.parameters.count("searches") == 0)
    planner->params().setParam("searches", "1");  // the path must not depend on the speed of threads
  if (auto* const user = dynamic_cast<TriesKnownPaths*>(planner.get()); user && query_.known_paths && query_.seed == 0)
    user->setKnownPaths(knownPaths());
  planner->setProblemDefinition(definition);
  planner->setup();
  const ob::PlannerStatus status = planner->solve(within(query_.seconds - secondsSince(begin_)));
  result_.planning_seconds = secondsSince(begin_);
  const bool exact = status == ob::PlannerStatus::EXACT_SOLUTION;
  result_.status = exact ? PlanningStatus::Solved : PlanningStatus::NoSolution;
  if (!exact)
    result_.message = "no solution within " + seconds(query_.seconds) + " (" + planner->getName() + ": " +
                      status.asString() + ")" + reasonOfDelay();
  if (!definition->hasSolution() && !exact)
    return;
  const auto path = std::dynamic_pointer_cast<og::PathGeometric>(definition->getSolutionPath());
  if (const std::string wrong = faultOf(path.get(), exact ? goals.get() : nullptr); !wrong.empty())
  {
    // If the time is too short for a solution, OMPL's RRTConnect sometimes returns a path that does not begin at the
    // start.
    result_.status = PlanningStatus::NoSolution;
    result_.message += (exact ? "" : "; ") + planner->getName() + " returned " + wrong;
    return;
  }
  if (!exact)
  {
    result_.status = PlanningStatus::Approximate;
    result_.message += "; the path ends " + std::to_string(definition->getSolutionDifference()) + " from a goal";
  }
  finish(*path, exact ? goals : nullptr, planner->getName());
}

/// Simplifies and optimizes the path, then checks the result once more, because not every planner checks all motions of
/// its path. `goals`: null if the path does not end at one of them.
void Plan::finish(og::PathGeometric& path, const ob::GoalPtr& goals, const std::string& planner)
{
  constexpr double kPart = 0.1;   // of the planning time
  constexpr double kLeast = 0.1;  // seconds
  const Clock::time_point start = Clock::now();
  const double left = std::max({kLeast, kPart * query_.seconds, query_.seconds - result_.planning_seconds});
  if (query_.simplify)
    PathShortcutter(information_).shorten(path, within(left));
  if (query_.optimize_seconds > 0.0 && goals)
    PathOptimizer(information_, goals).improve(path, within(query_.optimize_seconds));
  result_.simplification_seconds = secondsSince(start);
  const bool valid = validator_->validatePath(path, within(left));
  result_.planning_seconds += secondsSince(start) - result_.simplification_seconds;
  if (valid)
  {
    result_.waypoints = waypointsOf(path, *space_, query_.start);
    return;
  }
  result_.status = PlanningStatus::NoSolution;
  result_.message = "the path of " + planner + " is not valid by the motion rule, or there was no time to prove it";
}

PlanningResult Plan::run(const PlannerFactory& factory)
{
  const CheckedEndpoints endpoints = checkEndpoints(*scene_, *checker_, space_, query_, constraints_.get());
  result_.status = endpoints.status;
  result_.message = endpoints.message;
  const ob::GoalPtr goal = endpoints.message.empty() ? goalOf(endpoints) : nullptr;
  endpoint_seconds_ = result_.planning_seconds = secondsSince(begin_);
  if (goal)
    findPath(factory, goal);
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
  validateQuery(*scene, query);
  const std::unique_lock<std::mutex> lock = seeded(query.seed);
  return Plan(scene, checker, query, stop).run(factory);
}
}  // namespace gpu_planning_scene::core
