// path_length_study: the lengths of the paths that planners have found after a time, for the planning problems of
// ../shared or $GPU_PLANNING_SCENE_DATA. All planners use this package's checker. See --help.

#include <array>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/AITstar.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "benchmark/csv_table.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/anytime_batch.h"
#include "gpu_planning_scene/planning/path_length_objective.h"
#include "planning/planning_case.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<double, 10> kTimes = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0};  // seconds

const std::vector<std::string>& plannerNames()
{
  static const std::vector<std::string> names = {"AnytimeBatch", "RRTstar", "BITstar", "AITstar"};
  return names;
}

ob::PlannerPtr makePlanner(const std::string& name, const ob::SpaceInformationPtr& information)
{
  if (name == "AnytimeBatch")
    return std::make_shared<AnytimeBatch>(information);
  if (name == "RRTstar")
    return std::make_shared<og::RRTstar>(information);
  if (name == "BITstar")
    return std::make_shared<og::BITstar>(information);
  return std::make_shared<og::AITstar>(information);
}

/// The length of the best path so far: the planner's property "best cost REAL" or "best cost DOUBLE".
double bestLength(const ob::Planner& planner)
{
  for (const auto& [name, property] : planner.getPlannerProgressProperties())
    if (name.rfind("best cost", 0) == 0)
      return std::stod(property());
  return kInfinity;
}

/// The length of the best path at each of kTimes.
using Lengths = std::array<double, kTimes.size()>;

Lengths plan(const PlanningProblem& problem, const std::shared_ptr<StateChecker>& checker, const std::string& name,
             MotionRule rule, double seconds, unsigned int seed)
{
  ompl::RNG::setSeed(seed);
  const PlanningCase in(problem, checker, rule);
  in.definition->setOptimizationObjective(std::make_shared<PathLengthObjective>(in.information));
  const ob::PlannerPtr planner = makePlanner(name, in.information);
  planner->setProblemDefinition(in.definition);
  planner->setup();
  Lengths lengths;
  lengths.fill(kInfinity);
  std::size_t next = 0;
  double known = kInfinity;  // at the last look: a path that was found since then may have been found after the time
  const Stopwatch watch;
  const ob::PlannerTerminationCondition ptc(
      [&]
      {
        const double now = watch.seconds();
        for (; next < kTimes.size() && now >= kTimes[next]; ++next)
          lengths[next] = known;
        known = bestLength(*planner);
        return now >= seconds;
      });
  planner->solve(ptc);
  double last = kInfinity;
  if (in.definition->hasExactSolution())
    last = in.definition->getSolutionPath()->length();
  for (; next < kTimes.size() && kTimes[next] <= seconds; ++next)
    lengths[next] = last;
  return lengths;
}

void study(const CommandLine& arguments)
{
  const StudySettings settings(arguments);
  const MotionRule rule = motionRuleFromName(arguments.value("--rule", "bound"));
  CsvTable table(settings.out, "path_lengths.csv", {"problem", "planner", "seconds", "length"});
  ProblemChecker checkers(settings.device);
  std::map<std::string, std::array<std::vector<double>, kTimes.size()>> found;
  const std::vector<std::string> chosen = chosenPlanningProblems(settings.problems);
  for (std::size_t i = 0; i < chosen.size(); ++i)
  {
    const PlanningProblem problem = loadPlanningProblem(chosen[i]);
    const std::shared_ptr<StateChecker> checker = checkers.in(problem);
    for (const std::string& name : plannerNames())
    {
      if (!settings.isChosen(name))
        continue;
      const Lengths lengths = plan(problem, checker, name, rule, settings.seconds, static_cast<unsigned int>(1 + i));
      for (std::size_t k = 0; k < kTimes.size() && kTimes[k] <= settings.seconds; ++k)
      {
        table.add({chosen[i], name, kTimes[k], lengths[k]});
        found[name][k].push_back(lengths[k]);
      }
    }
  }
  for (const auto& [name, by_time] : found)
    for (std::size_t k = 0; k < kTimes.size() && kTimes[k] <= settings.seconds; ++k)
    {
      std::vector<double> solved;
      for (const double length : by_time[k])
        if (length < kInfinity)
          solved.push_back(length);
      std::cout << name << " after " << kTimes[k] << " s: " << solved.size() << " of " << by_time[k].size()
                << " solved, median length " << median(solved) << std::endl;
    }
}
}  // namespace
}  // namespace gpu_planning_scene::core::benchmark

int main(int argc, char** argv)
{
  using namespace gpu_planning_scene::core;
  ompl::msg::noOutputHandler();
  std::vector<Option> options = benchmark::StudySettings::options();
  options.push_back({"--rule", "RULE", "motion rule: bound (default) or samples"});
  const Tool tool{
      "path_length_study", "--out DIR [OPTIONS]",
      "Lets planners shorten paths of the ur5, and records the length of the best path after 0.01 to 10 s:\n"
      "AnytimeBatch, and OMPL's RRTstar, BITstar and AITstar on this package's checker. Writes\n"
      "path_lengths.csv, a row for each problem, planner and time.",
      options, benchmark::study};
  return runTool(tool, argc, argv);
}
