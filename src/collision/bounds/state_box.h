#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "collision/bounds/joint_levers.h"
#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// A range of each joint's position. It bounds how far the joints move the robot's points within it. One caller at a
/// time.
class StateBox
{
 public:
  explicit StateBox(const RobotModel& robot);

  /// Makes the box contain states and their neighbourhoods. `lower`, `upper`: the range of each variable over the
  /// states. `state`: one of them. `travel`: of each joint in the neighbourhoods; it must outlive the calls of
  /// sumSteps().
  void set(const double* lower, const double* upper, const double* state, const JointTravel* travel);

  /// Writes, for the first 0, 1, 2, ... steps of a chain, the largest displacement of the chain's instance, in metres,
  /// while the joints of these steps move by their travel from one of the states. It may be infinite.
  void sumSteps(const LeverChain& chain, double* sums) const;

 private:
  double armOf(const LeverChain& chain, const LeverChain::Step& step, double beyond) const;

  const RobotModel& robot_;
  const JointTravel* travel_ = nullptr;
  std::vector<double> middle_;
  std::vector<double> half_;              // of each joint: how far its position may be from the middle
  std::vector<Eigen::Isometry3d> poses_;  // of the links, in the middle
};
}  // namespace gpu_planning_scene::core
