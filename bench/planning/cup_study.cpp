// cup_study: plans among the shelves of ../shared or $GPU_PLANNING_SCENE_DATA with a tool that must not tilt, as if it
// carried a full cup. OMPL's constrained planner stands beside ours. See --help.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <ompl/util/Console.h>

#include "benchmark/csv_table.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/collision_free_ik.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "planning/planning_case.h"
#include "planning/projected_planner.h"
#include "scene/frame.h"
#include "support/states_along.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr double kTilt = 0.1;   // radians about each horizontal axis; the turn about the vertical is free
constexpr double kNear = 0.02;  // metres: the ends are this close to those of the problem
constexpr std::size_t kGoals = 8;

/// The z axis of the tip points up.
KinematicConstraints upright(int tip, double tilt)
{
  KinematicConstraints constraints;
  OrientationConstraint orientation;
  orientation.link = tip;
  orientation.tolerance = {tilt, tilt, 4.0};
  constraints.orientations.push_back(orientation);
  return constraints;
}

/// Upright free states whose tip is near that of a state of the problem.
std::vector<std::vector<double>> uprightNear(const PlanningProblem& problem, StateChecker& checker,
                                             const std::vector<double>& state, std::size_t count)
{
  const RobotModel& robot = *problem.scene->robot;
  const int tip = tipOf(robot, robot.group(problem.group));
  KinematicConstraints goal = upright(tip, 0.8 * kTilt);
  PositionConstraint position;
  position.link = tip;
  position.pose.translation() = linkPose(robot, tip, state.data()).translation();
  position.region = Sphere{kNear};
  goal.positions.push_back(position);
  CollisionFreeIkOptions options;
  options.ik.max_solutions = count;
  return solveCollisionFree(*problem.scene, checker, problem.group, {goal}, state, options).front().states;
}

struct Judgement
{
  double largest_tilt = 0.0;
  std::size_t colliding = 0;
};

/// Judges the straight motions between rows at ten times the resolution.
Judgement judge(const PlanningProblem& problem, StateChecker& checker, const std::vector<std::vector<double>>& rows)
{
  const RobotModel& robot = *problem.scene->robot;
  const int tip = tipOf(robot, robot.group(problem.group));
  const std::vector<double> states = statesAlong(robot, rows);
  const std::size_t width = robot.variables().size();
  Judgement judgement;
  for (std::size_t i = 0; i < states.size(); i += width)
  {
    // The Euler angles of a rotation Rx(a) Ry(b) Rz(c), from its third column.
    const Eigen::Vector3d up = linkPose(robot, tip, &states[i]).linear().col(2);
    judgement.largest_tilt = std::max({judgement.largest_tilt, std::abs(std::atan2(-up.y(), up.z())),
                                       std::abs(std::asin(std::clamp(up.x(), -1.0, 1.0)))});
  }
  for (const std::uint8_t valid : checker.check(states.data(), states.size() / width, problem.group).valid)
    judgement.colliding += valid == 0 ? 1 : 0;
  return judgement;
}

struct Outcomes
{
  std::vector<double> seconds;
  std::size_t solved = 0;
  std::size_t tilted = 0;  // solved problems whose path tilts by more than the tolerance
  std::size_t colliding = 0;
  double largest_tilt = 0.0;

  void add(bool is_solved, double time, const Judgement& judgement)
  {
    seconds.push_back(time);
    solved += is_solved ? 1 : 0;
    tilted += judgement.largest_tilt > kTilt ? 1 : 0;
    colliding += judgement.colliding != 0 ? 1 : 0;
    largest_tilt = std::max(largest_tilt, judgement.largest_tilt);
  }
};

void study(const CommandLine& arguments)
{
  const StudySettings settings(arguments);
  CsvTable table(settings.out, "cup.csv", {"problem", "planner", "solved", "seconds", "largest_tilt", "colliding"});
  ProblemChecker checkers(settings.device);
  std::map<std::string, Outcomes> outcomes;
  std::size_t without_ends = 0;
  for (const std::string& name : chosenPlanningProblems(1000000))
  {
    if (name.find("bookshelf") == std::string::npos || outcomes["BatchRrtConnect"].seconds.size() >= settings.problems)
      continue;
    const PlanningProblem problem = loadPlanningProblem(name);
    const std::shared_ptr<StateChecker> checker = checkers.in(problem);
    const std::vector<std::vector<double>> starts = uprightNear(problem, *checker, problem.start, 1);
    const std::vector<std::vector<double>> goals = uprightNear(problem, *checker, problem.goal, kGoals);
    if (starts.empty() || goals.empty())
    {
      ++without_ends;
      continue;
    }
    const KinematicConstraints constraints =
        upright(tipOf(*problem.scene->robot, problem.scene->robot->group(problem.group)), kTilt);
    const auto record =
        [&](const std::string& planner, bool is_solved, double seconds, const std::vector<std::vector<double>>& rows)
    {
      const Judgement judgement = judge(problem, *checker, rows);
      outcomes[planner].add(is_solved, seconds, judgement);
      table.add({name, planner, std::size_t{is_solved}, seconds, judgement.largest_tilt, judgement.colliding});
    };
    if (settings.isChosen("BatchRrtConnect"))
    {
      PlanningQuery query;
      query.group = problem.group;
      query.start = starts.front();
      query.goals = goals;
      query.seconds = settings.seconds;
      query.path_constraints = constraints;
      const PlanningResult result = planMotion(problem.scene, checker, query, PlannerFactoryOf<BatchRrtConnect>());
      if (result.status != PlanningStatus::Solved)
        std::cout << name << ": " << result.message << std::endl;
      const bool is_solved = result.status == PlanningStatus::Solved;
      record("BatchRrtConnect", is_solved, result.planning_seconds,
             is_solved ? result.waypoints : std::vector<std::vector<double>>());
    }
    if (settings.isChosen("ProjectedRRTConnect"))
    {
      const ProjectedPath path =
          planProjected(problem.scene, checker, problem.group, constraints, starts.front(), goals, settings.seconds);
      record("ProjectedRRTConnect", path.is_solved, path.seconds, path.rows);
    }
  }
  for (const auto& [planner, all] : outcomes)
    std::cout << planner << ": " << all.solved << " of " << all.seconds.size() << " solved, median "
              << 1e3 * median(all.seconds) << " ms, 95 % " << 1e3 * percentile(all.seconds, 0.95) << " ms; "
              << all.tilted << " paths tilt too much (most " << all.largest_tilt << " of " << kTilt << " rad), "
              << all.colliding << " collide" << std::endl;
  std::cout << without_ends << " problems have no upright free start or goal" << std::endl;
}
}  // namespace
}  // namespace gpu_planning_scene::core::benchmark

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  ompl::msg::noOutputHandler();
  return runTool({"cup_study", "--out DIR [options]",
                  "Plans among shelves with a tool that stays upright up to 0.1 rad, with the batch planner and with "
                  "OMPL's RRTConnect in its ProjectedStateSpace, and judges the paths at ten times the resolution.",
                  benchmark::StudySettings::options(), benchmark::study},
                 argc, argv);
}
