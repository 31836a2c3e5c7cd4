#include "planning/planning_case.h"

#include <iostream>

#include "benchmark/csv_table.h"
#include "collision/checkers/open_checker.h"
#include "collision/cpu/cpu_scene.h"
#include "collision/proofs/proof_worker.h"

namespace gpu_planning_scene::core::benchmark
{
namespace ob = ompl::base;

namespace
{
constexpr std::size_t kAllProblems = 1000000;
}  // namespace

StudySettings::StudySettings(const CommandLine& arguments)
  : out(arguments.required("--out")),
    device(arguments.value("--device", "auto")),
    planners(arguments.value("--planners", "")),
    problems(arguments.count("--problems", kAllProblems, 1, kAllProblems)),
    seconds(arguments.number("--seconds", 10.0, 1e-3, 1e6))
{
  makeTableFolder(out);
}

std::vector<Option> StudySettings::options()
{
  return {{"--out", "DIR", "folder for the tables"},
          {"--problems", "N", "number of problems, spread over all sets (default: all)"},
          {"--seconds", "S", "time of each plan, at most (default 10)"},
          {"--planners", "NAME", "only planners with this in their name, for example \"batch\" (default: all)"},
          {"--device", "D", "\"auto\" (a GPU, else llvmpipe), \"software\", an index, part of a renderer's name"}};
}

PlanningCase::PlanningCase(const PlanningProblem& problem, const std::shared_ptr<StateChecker>& checker,
                           MotionRule rule)
  : space(std::make_shared<GroupStateSpace>(problem.scene->robot, problem.group)),
    information(std::make_shared<ob::SpaceInformation>(space)),
    definition(std::make_shared<ob::ProblemDefinition>(information))
{
  options.rule = rule;
  states = std::make_shared<StateValidityChecker>(information, problem.scene, checker);
  motions = std::make_shared<MotionValidator>(information, problem.scene, checker, options);
  information->setStateValidityChecker(states);
  information->setMotionValidator(motions);
  information->setup();
  ob::ScopedState<> start(space);
  ob::ScopedState<> goal(space);
  space->copyFromRow(problem.start.data(), start.get());
  space->copyFromRow(problem.goal.data(), goal.get());
  definition->setStartAndGoalStates(start, goal);
}

std::shared_ptr<StateChecker> ProblemChecker::in(const PlanningProblem& problem)
{
  if (checker_)
    checker_->setScene(problem.scene);
  else
  {
    BatchCheckerOptions options;
    options.device = device_;
    checker_ = openChecker(problem.scene, options,
                           [](const std::string& warning) { std::cerr << "warning: " << warning << std::endl; });
    std::cout << "device: " << checker_->deviceName() << std::endl;
  }
  std::vector<double> rows;
  for (std::size_t i = 0; i < kStatesBeforeProofs; ++i)
    rows.insert(rows.end(), problem.start.begin(), problem.start.end());
  checker_->check(rows.data(), kStatesBeforeProofs, problem.group);
  checker_->check(rows.data(), kStatesBeforeProofs, problem.group);
  waitForProofs();
  checker_->check(rows.data(), 64, problem.group);
  checker_->report(problem.group);
  return checker_;
}
}  // namespace gpu_planning_scene::core::benchmark
