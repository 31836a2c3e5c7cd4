#include "gpu_planning_scene/planning/collision_free_ik.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/error_place.h"
#include "base/parallel_for.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "model/inverse_kinematics/ik_search.h"
#include "model/inverse_kinematics/kinematic_chains.h"
#include "model/joint_limits.h"

// Rounds: each goal without enough solutions proposes its next candidate, and all candidates are checked in one batch.
// Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kGoalsPerChunk = 8;

// More candidates than wanted solutions: some collide.
constexpr std::size_t kCandidatesPerSolution = 50;

IkOptions candidateOptions(IkOptions options)
{
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max() / kCandidatesPerSolution;
  options.max_solutions = std::min(options.max_solutions, kMost) * kCandidatesPerSolution;
  return options;
}

/// The search for the solutions of one goal.
struct GoalSearch
{
  GoalSearch(const std::shared_ptr<const RobotModel>& robot, const std::string& group, const KinematicConstraints& goal,
             const std::vector<double>& state, const CollisionFreeIkOptions& options)
    : kinematics(robot, group, goal), search(kinematics, state.data(), candidateOptions(options.ik))
  {
  }

  InverseKinematics kinematics;
  IkSearch search;
  std::optional<std::vector<double>> candidate;
  std::vector<std::pair<double, std::vector<double>>> solutions;  // with their distances
  BodyPair first_collision = kNoPair;
  double distance_of_collision = 0.0;  // of its candidate from the given state
  std::size_t collisions = 0;
};

/// Throws Error if the search keeps a value of the given state that is outside its limits. It moves only variables that
/// move a link of the goal, and only those get within their limits.
void requireLimitsOfKept(const InverseKinematics& kinematics, const Group& group, const std::vector<double>& state)
{
  const RobotModel& robot = kinematics.chains().robot();
  std::vector<double> kept = state;
  kinematics.constraints().clampJoints(kept.data());
  ValuesOutsideLimits outside(robot);
  for (const int variable : group.variables)
    if (const double value = kept[static_cast<std::size_t>(variable)];
        isOutsideLimits(robot.variables()[static_cast<std::size_t>(variable)], value) &&
        !std::binary_search(kinematics.variables().begin(), kinematics.variables().end(), variable))
      outside.add(variable, value);
  if (outside.count() != 0)
    throw Error("the given state must be within the limits of the joints that the search does not move: " +
                outside.text());
}

/// The state with values of the group at their limits if they are outside by rounding alone.
std::vector<double> withoutRounding(const RobotModel& robot, const Group& group, std::vector<double> state)
{
  for (const int index : group.variables)
    if (const Variable& variable = robot.variables()[static_cast<std::size_t>(index)]; variable.bounded)
      if (double& value = state[static_cast<std::size_t>(index)]; !isOutsideLimits(variable, value))
        value = std::clamp(value, variable.lower, variable.upper);
  return state;
}

double distanceBetween(const std::vector<int>& variables, const std::vector<double>& a, const std::vector<double>& b)
{
  double sum = 0.0;
  for (const int variable : variables)
  {
    const auto i = static_cast<std::size_t>(variable);
    sum += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::sqrt(sum);
}

class Solver
{
 public:
  Solver(const PlanningScene& scene, StateChecker& checker, const std::string& group, const std::vector<double>& state,
         const CollisionFreeIkOptions& options)
    : scene_(scene), checker_(checker), group_(group), state_(state), options_(options)
  {
  }

  void add(const KinematicConstraints& goal)
  {
    goals_.push_back(std::make_unique<GoalSearch>(scene_.robot, group_, goal, state_, options_));
  }

  /// Throws Error if a search keeps a value of the given state that is outside its limits.
  void requireKeptWithinLimits() const
  {
    for (const auto& goal : goals_)
      requireLimitsOfKept(goal->kinematics, scene_.robot->group(group_), state_);
  }

  std::vector<CollisionFreeIkResult> run(const std::function<bool()>& stop)
  {
    std::vector<GoalSearch*> open;
    for (const auto& goal : goals_)
      open.push_back(goal.get());
    while (!open.empty() && !(stop && stop()))
    {
      parallelFor(
          open.size(), kGoalsPerChunk,
          [&](std::size_t begin, std::size_t end)
          {
            for (std::size_t i = begin; i < end; ++i)
              open[i]->candidate = open[i]->search.next(stop);
          });
      open.erase(std::remove_if(open.begin(), open.end(), [](const GoalSearch* goal) { return !goal->candidate; }),
                 open.end());
      judge(open);
      open.erase(std::remove_if(open.begin(), open.end(),
                                [this](const GoalSearch* goal)
                                { return goal->solutions.size() >= options_.ik.max_solutions; }),
                 open.end());
    }
    std::vector<CollisionFreeIkResult> results;
    for (const auto& goal : goals_)
      results.push_back(resultOf(*goal));
    return results;
  }

 private:
  /// Checks the candidates of the goals in one batch.
  void judge(const std::vector<GoalSearch*>& goals) const
  {
    std::vector<double> rows;
    for (const GoalSearch* goal : goals)
      rows.insert(rows.end(), goal->candidate->begin(), goal->candidate->end());
    BatchResult checked;
    if (options_.check_collisions && !goals.empty())
      checked = checker_.check(rows.data(), goals.size(), group_);
    for (std::size_t i = 0; i < goals.size(); ++i)
    {
      GoalSearch& goal = *goals[i];
      const double distance = distanceBetween(scene_.robot->group(group_).variables, *goal.candidate, state_);
      if (!options_.check_collisions || checked.valid[i] != 0)
      {
        goal.solutions.emplace_back(distance, std::move(*goal.candidate));
        continue;
      }
      if (++goal.collisions == 1 || distance < goal.distance_of_collision)
      {
        goal.first_collision = checked.colliding[i];
        goal.distance_of_collision = distance;
      }
    }
  }

  CollisionFreeIkResult resultOf(GoalSearch& goal) const
  {
    CollisionFreeIkResult result;
    std::stable_sort(goal.solutions.begin(), goal.solutions.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [distance, state] : goal.solutions)
    {
      result.distances.push_back(distance);
      result.states.push_back(std::move(state));
    }
    if (!result.states.empty())
      result.status = IkStatus::Solved;
    else if (goal.collisions != 0)
    {
      result.status = IkStatus::InCollision;
      result.message = "no solution without collision: of " + std::to_string(goal.collisions) +
                       (goal.collisions == 1 ? " solution, the" : " solutions, the nearest to the given state") +
                       (goal.collisions == 1 ? " only one collides: " : " collides: ") +
                       scene_.bodyName(goal.first_collision[0]) + " and " + scene_.bodyName(goal.first_collision[1]);
    }
    else
      result.message = faultOf(goal);
    return result;
  }

  static std::string faultOf(const GoalSearch& goal)
  {
    if (goal.search.nearest().empty())
      return "no solution: the search was stopped";
    const std::string nearest = goal.kinematics.violation(goal.search.nearest().data()).text();
    return "no solution in " + std::to_string(goal.search.attempts()) + " attempts: the nearest state is " + nearest;
  }

  const PlanningScene& scene_;
  StateChecker& checker_;
  const std::string& group_;
  const std::vector<double>& state_;
  const CollisionFreeIkOptions& options_;
  std::vector<std::unique_ptr<GoalSearch>> goals_;
};
}  // namespace

std::vector<CollisionFreeIkResult> solveCollisionFree(const PlanningScene& scene, StateChecker& checker,
                                                      const std::string& group,
                                                      const std::vector<KinematicConstraints>& goals,
                                                      const std::vector<double>& state,
                                                      const CollisionFreeIkOptions& options,
                                                      const std::function<bool()>& stop)
{
  if (state.size() != scene.robot->variables().size())
    throw Error("the state has " + std::to_string(state.size()) + " values; the robot has " +
                std::to_string(scene.robot->variables().size()) + " variables");
  validateStates(*scene.robot, state.data(), 1);
  const std::vector<double> start = withoutRounding(*scene.robot, scene.robot->group(group), state);
  Solver solver(scene, checker, group, start, options);
  for (std::size_t i = 0; i < goals.size(); ++i)
  {
    const auto add = [&] { solver.add(goals[i]); };
    if (goals.size() == 1)
      add();
    else
      withErrorPlace("goal " + std::to_string(i), add);
  }
  solver.requireKeptWithinLimits();
  return solver.run(stop);
}
}  // namespace gpu_planning_scene::core
