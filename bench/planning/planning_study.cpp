// planning_study: solves the planning problems of ../shared or $GPU_PLANNING_SCENE_DATA under both motion rules. It
// compares the batch planner without and with a known path, OMPL's RRTConnect with this package's validator, and
// RRTConnect with FCL. The planners use the same seeds and run one after the other. The exact checker checks each path
// again at ten times the resolution. See --help.

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "benchmark/csv_table.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/path_shortcutter.h"
#include "planning/fcl_checker.h"
#include "planning/planning_case.h"
#include "support/states_along.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
namespace ob = ompl::base;
namespace og = ompl::geometric;

enum class Method
{
  Batch,
  BatchBack,
  RrtConnect,
  RrtConnectFcl
};
constexpr Method kMethods[] = {Method::Batch, Method::BatchBack, Method::RrtConnect, Method::RrtConnectFcl};

const char* nameOf(Method method)
{
  switch (method)
  {
    case Method::Batch:
      return "batch planner";
    case Method::BatchBack:
      return "batch planner, way back that is known";
    case Method::RrtConnect:
      return "RRTConnect, our validator";
    case Method::RrtConnectFcl:
      return "RRTConnect, FCL";
  }
  return "";
}

const char* nameOf(MotionRule rule)
{
  return rule == MotionRule::Bound ? "bound" : "samples";
}

struct Outcome
{
  bool solved = false;
  double seconds = 0.0;
  double length = 0.0;
  std::size_t waypoints = 0;
  std::uint64_t states = 0;  // checked during planning
  std::size_t checked_again = 0;
  std::size_t colliding = 0;  // states, of `checked_again`
};

/// Checks a path state by state, at ten times the resolution of the planner.
void checkAgain(const og::PathGeometric& path, const GroupStateSpace& space, const PlanningProblem& problem,
                const MotionSteps& steps, CpuChecker& exact, Outcome& outcome)
{
  const RobotModel& robot = *problem.scene->robot;
  std::vector<std::vector<double>> rows(path.getStateCount(), problem.start);
  for (unsigned int i = 0; i < path.getStateCount(); ++i)
    space.copyToRow(path.getState(i), rows[i].data());
  const std::vector<double> states = statesAlong(robot, rows, {0.1 * steps.revolute, 0.1 * steps.prismatic});
  const std::vector<std::uint8_t> valid =
      exact.check(states.data(), states.size() / problem.start.size(), problem.group).valid;
  outcome.checked_again = valid.size();
  outcome.colliding = static_cast<std::size_t>(std::count(valid.begin(), valid.end(), 0));
}

class Study
{
 public:
  Study(StudySettings settings, std::size_t runs)
    : settings_(std::move(settings)),
      runs_(runs),
      ours_(settings_.device),
      table_(settings_.out, "planning.csv",
             {"problem", "run", "rule", "method", "solved", "seconds", "length", "waypoints", "states_checked",
              "checked_again", "colliding"})
  {
  }

  /// Returns whether a path that was accepted under the bound collides.
  bool run()
  {
    const std::vector<std::string> chosen = chosenPlanningProblems(settings_.problems);
    for (std::size_t i = 0; i < chosen.size(); ++i)
      runProblem(chosen[i], i);
    summarize();
    return wrong_;
  }

 private:
  bool isChosen(Method method) const { return settings_.isChosen(nameOf(method)); }

  void runProblem(const std::string& name, std::size_t number)
  {
    const PlanningProblem problem = loadPlanningProblem(name);
    const std::shared_ptr<StateChecker> ours = ours_.in(problem);
    if (exact_)
      exact_->setScene(problem.scene);
    else
      exact_ = std::make_shared<CpuChecker>(problem.scene);
    const auto fcl = isChosen(Method::RrtConnectFcl) ? std::make_shared<FclChecker>(problem.scene, problem.group)
                                                     : std::shared_ptr<FclChecker>();
    for (std::size_t run = 0; run < runs_; ++run)
      for (const MotionRule rule : {MotionRule::Bound, MotionRule::Samples})
        for (std::size_t k = 0; k < std::size(kMethods); ++k)
        {
          const Method method = kMethods[(k + number) % std::size(kMethods)];
          if (!isChosen(method))
            continue;
          const std::shared_ptr<StateChecker> checker =
              method == Method::RrtConnectFcl ? std::static_pointer_cast<StateChecker>(fcl) : ours;
          const Outcome outcome =
              plan(problem, method, rule, checker, static_cast<unsigned int>(1 + number + 1000 * run));
          wrong_ = wrong_ || (rule == MotionRule::Bound && outcome.colliding != 0 && method != Method::RrtConnectFcl);
          outcomes_[{nameOf(rule), nameOf(method)}].push_back(outcome);
          table_.add({name, run, nameOf(rule), nameOf(method), outcome.solved ? "1" : "0", outcome.seconds,
                      outcome.length, outcome.waypoints, static_cast<std::size_t>(outcome.states),
                      outcome.checked_again, outcome.colliding});
        }
  }

  Outcome plan(const PlanningProblem& problem, Method method, MotionRule rule,
               const std::shared_ptr<StateChecker>& checker, unsigned int seed)
  {
    ompl::RNG::setSeed(seed);
    const PlanningCase in(problem, checker, rule);
    std::unique_ptr<ob::Planner> planner;
    if (method == Method::Batch)
      planner = std::make_unique<BatchRrtConnect>(in.information);
    else if (method == Method::BatchBack)
      planner = plannerOfWayBack(in, problem, checker);
    else
      planner = std::make_unique<og::RRTConnect>(in.information);
    if (!planner)
      return {};
    planner->setProblemDefinition(in.definition);
    planner->setup();

    Outcome outcome;
    const Stopwatch watch;
    const ob::PlannerStatus status = planner->solve(ob::timedPlannerTerminationCondition(settings_.seconds));
    outcome.seconds = watch.seconds();
    outcome.solved = status == ob::PlannerStatus::EXACT_SOLUTION;
    outcome.states = in.statesChecked();
    if (outcome.solved)
    {
      const auto& path = *in.definition->getSolutionPath()->as<og::PathGeometric>();
      outcome.length = path.length();
      outcome.waypoints = path.getStateCount();
      checkAgain(path, *in.space, problem, in.options.steps, *exact_, outcome);
    }
    return outcome;
  }

  /// The planner for a problem whose way back was planned, and shortened as in ~plan. This is not part of its time.
  /// Null: no way back was found.
  std::unique_ptr<ob::Planner> plannerOfWayBack(const PlanningCase& in, PlanningProblem problem,
                                                const std::shared_ptr<StateChecker>& checker) const
  {
    std::swap(problem.start, problem.goal);
    const PlanningCase there(problem, checker, in.options.rule);
    BatchRrtConnect first(there.information);
    first.setProblemDefinition(there.definition);
    first.setup();
    const auto end = ob::timedPlannerTerminationCondition(settings_.seconds);
    if (first.solve(end) != ob::PlannerStatus::EXACT_SOLUTION)
      return nullptr;
    auto& path = *there.definition->getSolutionPath()->as<og::PathGeometric>();
    PathShortcutter(there.information).shorten(path, end);
    auto planner = std::make_unique<BatchRrtConnect>(in.information);
    planner->setKnownPaths({path});
    return planner;
  }

  void summarize() const
  {
    CsvTable table(settings_.out, "planning_summary.csv",
                   {"rule", "method", "problems", "solved", "median_s", "p95_s", "max_s", "median_length",
                    "median_states", "checked_again", "colliding"});
    for (const auto& [key, outcomes] : outcomes_)
    {
      std::vector<double> seconds;
      std::vector<double> lengths;
      std::vector<double> states;
      std::size_t again = 0;
      std::size_t colliding = 0;
      for (const Outcome& outcome : outcomes)
      {
        seconds.push_back(outcome.seconds);
        states.push_back(static_cast<double>(outcome.states));
        if (outcome.solved)
          lengths.push_back(outcome.length);
        again += outcome.checked_again;
        colliding += outcome.colliding;
      }
      table.add({key.first, key.second, outcomes.size(), lengths.size(), median(seconds), percentile(seconds, 0.95),
                 percentile(seconds, 1.0), median(lengths), median(states), again, colliding});
      std::cout << key.first << ", " << key.second << ": " << lengths.size() << " of " << outcomes.size()
                << " solved, median " << median(seconds) << " s, p95 " << percentile(seconds, 0.95) << " s, length "
                << median(lengths) << ", " << median(states) << " states, " << colliding << " of " << again
                << " states of paths collide" << std::endl;
    }
  }

  const StudySettings settings_;
  const std::size_t runs_;
  ProblemChecker ours_;
  CsvTable table_;
  std::shared_ptr<CpuChecker> exact_;
  std::map<std::pair<std::string, std::string>, std::vector<Outcome>> outcomes_;
  bool wrong_ = false;
};

void study(const CommandLine& arguments)
{
  if (Study(StudySettings(arguments), arguments.count("--runs", 1, 1, 1000000)).run())
    throw Error("a path that was accepted under the bound collides: see planning.csv");
}
}  // namespace
}  // namespace gpu_planning_scene::core::benchmark

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  ompl::msg::noOutputHandler();
  std::vector<Option> options = benchmark::StudySettings::options();
  options.push_back({"--runs", "N", "runs of each problem with different seeds (default 1)"});
  const Tool tool{
      "planning_study", "--out DIR [OPTIONS]",
      "Plans the problems of the ur5 with the batch planner, also with the way back as a known path, and with\n"
      "OMPL's RRTConnect on this package's checker and on FCL, under both motion rules. Prints how many are\n"
      "solved and how fast. Writes planning.csv, a row for each plan, and planning_summary.csv.\n"
      "Exit code: 0 no wrong path, 1 a path that was accepted under the bound collides, or another error,\n"
      "2 bad usage.",
      options, benchmark::study};
  return runTool(tool, argc, argv);
}
