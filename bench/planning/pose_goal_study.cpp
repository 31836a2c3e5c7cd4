// pose_goal_study: the planning problems of ../shared or $GPU_PLANNING_SCENE_DATA, with their goals as joint values and
// as poses of the tip. See --help.

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <ompl/util/Console.h>

#include "benchmark/csv_table.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "gpu_planning_scene/inverse_kinematics.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "planning/planning_case.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
// MoveIt's defaults for pose targets.
constexpr double kPositionTolerance = 1e-4;     // metres
constexpr double kOrientationTolerance = 1e-3;  // radians

KinematicConstraints poseOf(const PlanningProblem& problem, const std::vector<double>& state)
{
  const RobotModel& robot = *problem.scene->robot;
  const int tip = tipOf(robot, robot.group(problem.group));
  return KinematicConstraints::pose(tip, Eigen::Isometry3d::Identity(), linkPose(robot, tip, state.data()),
                                    kPositionTolerance, kOrientationTolerance);
}

struct Outcomes
{
  std::vector<double> seconds;  // of all plans; a plan that failed has the time that it took
  std::size_t solved = 0;
  std::size_t off_goal = 0;  // solved plans whose end is not the pose

  std::string text() const
  {
    return std::to_string(solved) + " of " + std::to_string(seconds.size()) + " solved, " + std::to_string(off_goal) +
           " off the pose, median " + std::to_string(1e3 * median(seconds)) + " ms, 95 % " +
           std::to_string(1e3 * percentile(seconds, 0.95)) + " ms";
  }
};

void study(const CommandLine& arguments)
{
  const StudySettings settings(arguments);
  CsvTable table(settings.out, "pose_goals.csv", {"problem", "rule", "goal", "solved", "seconds"});
  ProblemChecker checkers(settings.device);
  std::map<std::string, Outcomes> outcomes;
  for (const std::string& name : chosenPlanningProblems(settings.problems))
  {
    const PlanningProblem problem = loadPlanningProblem(name);
    const std::shared_ptr<StateChecker> checker = checkers.in(problem);
    const KinematicConstraints pose = poseOf(problem, problem.goal);
    for (const std::string rule : {"bound", "samples"})
      for (const std::string goal : {"joints", "pose"})
      {
        PlanningQuery query;
        query.group = problem.group;
        query.start = problem.start;
        query.seconds = settings.seconds;
        query.simplify = false;
        query.motions.rule = motionRuleFromName(rule);
        if (goal == "joints")
          query.goals = {problem.goal};
        else
          query.goal_regions = {pose};
        const PlanningResult result = planMotion(problem.scene, checker, query, PlannerFactoryOf<BatchRrtConnect>());
        const bool is_solved = result.status == PlanningStatus::Solved;
        Outcomes& all = outcomes[rule + ", " + goal];
        all.seconds.push_back(result.planning_seconds);
        all.solved += is_solved ? 1 : 0;
        if (is_solved)
        {
          std::vector<Eigen::Isometry3d> poses(problem.scene->robot->links().size());
          problem.scene->robot->linkPoses(result.waypoints.back().data(), poses.data());
          const ConstraintViolation off = violationOf(pose, poses.data(), result.waypoints.back().data());
          all.off_goal += off.sum() > 1e-9 ? 1 : 0;
        }
        else
          std::cout << name << ", " << rule << ", " << goal << ": " << result.message << std::endl;
        table.add({name, rule, goal, std::size_t{is_solved}, result.planning_seconds});
      }
  }
  for (const auto& [what, all] : outcomes)
    std::cout << what << ": " << all.text() << std::endl;
}
}  // namespace
}  // namespace gpu_planning_scene::core::benchmark

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  ompl::msg::noOutputHandler();
  return runTool({"pose_goal_study", "--out DIR [options]",
                  "Plans the problems with the batch planner, with their goals as joint values and as poses of the "
                  "tip, by both motion rules.",
                  benchmark::StudySettings::options(), benchmark::study},
                 argc, argv);
}
