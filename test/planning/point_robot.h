#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/motion_validator.h"

namespace gpu_planning_scene::core
{
/// A wall in the plane, given by its lower and upper corner (x, y).
struct Wall
{
  double x_lower;
  double y_lower;
  double x_upper;
  double y_upper;
};

/// A cube with edges of 0.1 m among walls. The group "plane" of two prismatic joints moves it in the plane, from -2 to
/// 2 m along each axis.
class PointRobot
{
 public:
  explicit PointRobot(const std::vector<Wall>& walls, const MotionCheckerOptions& options = {});

  using Position = std::pair<double, double>;
  ompl::base::ScopedState<> at(const Position& position) const;
  static Position positionOf(const ompl::base::State* state);

  /// The problem of a path from the start to any of the goals.
  ompl::base::ProblemDefinitionPtr problem(const Position& start, const std::vector<Position>& goals) const;
  ompl::geometric::PathGeometric path(const std::vector<Position>& positions) const;
  bool isValid(const ompl::geometric::PathGeometric& path) const { return validator_->validatePath(path); }

  const ompl::base::SpaceInformationPtr& information() const { return information_; }
  const MotionValidator& validator() const { return *validator_; }
  const std::shared_ptr<const PlanningScene>& scene() const { return scene_; }
  const std::shared_ptr<StateChecker>& checker() const { return checker_; }

 private:
  std::shared_ptr<const PlanningScene> scene_;
  std::shared_ptr<StateChecker> checker_;
  ompl::base::SpaceInformationPtr information_;
  std::shared_ptr<MotionValidator> validator_;
};
}  // namespace gpu_planning_scene::core
