#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>

#include "command_line/command_line.h"
#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning/motion_validator.h"
#include "gpu_planning_scene/planning/state_validity_checker.h"
#include "gpu_planning_scene/state_checker.h"
#include "support/planning_problems.h"

namespace gpu_planning_scene::core::benchmark
{
/// What the studies of planners have in common.
struct StudySettings
{
  explicit StudySettings(const CommandLine& arguments);
  static std::vector<Option> options();

  bool isChosen(const std::string& planner) const { return planner.find(planners) != std::string::npos; }

  std::string out;  ///< folder of the tables; it exists
  std::string device;
  std::string planners;  ///< part of the names of the chosen planners
  std::size_t problems;  ///< number of problems, spread over all sets
  double seconds;        ///< for each plan
};

/// A planning problem in OMPL's terms, with our validity checkers.
struct PlanningCase
{
  PlanningCase(const PlanningProblem& problem, const std::shared_ptr<StateChecker>& checker, MotionRule rule);

  std::uint64_t statesChecked() const { return states->statesChecked() + motions->statesChecked(); }

  MotionCheckerOptions options;
  std::shared_ptr<GroupStateSpace> space;
  ompl::base::SpaceInformationPtr information;
  std::shared_ptr<StateValidityChecker> states;
  std::shared_ptr<MotionValidator> motions;
  ompl::base::ProblemDefinitionPtr definition;
};

/// A checker that goes from problem to problem.
class ProblemChecker
{
 public:
  /// `device`: as BatchCheckerOptions::device.
  explicit ProblemChecker(std::string device) : device_(std::move(device)) {}

  /// The checker in the scene of the problem. All one-time work is done: for the scene, and the proofs of the robot. A
  /// node makes these after the first batches, and keeps them on disk.
  std::shared_ptr<StateChecker> in(const PlanningProblem& problem);

 private:
  const std::string device_;
  std::shared_ptr<StateChecker> checker_;
};
}  // namespace gpu_planning_scene::core::benchmark
