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

  /// Makes the box contain all states in which no joint differs from `center` by more than 1 + `spread` times its
  /// `travel`. Null: all states within the limits. `travel`: of each joint; it must outlive the calls of sumSteps().
  void set(const double* center, const JointTravel* travel, double spread);

  /// Writes, for the first 0, 1, 2, ... steps of a chain, the largest displacement of the chain's instance, in metres,
  /// while the joints of these steps move by their travel within the box. It may be infinite.
  void sumSteps(const LeverChain& chain, double* sums) const;

 private:
  /// One row for each ball, in metres and in the planning frame.
  struct PlacedBalls
  {
    using Numbers = Eigen::Array<double, kLeverBalls, 1>;

    Eigen::Array<double, kLeverBalls, 3> centers;
    Numbers radii;
  };

  PlacedBalls place(const LeverChain& chain) const;
  double armOf(const PlacedBalls& balls, const LeverChain::Step& step, double beyond) const;

  const RobotModel& robot_;
  const JointTravel* travel_ = nullptr;
  bool has_center_ = false;
  double reach_ = 0.0;                    // how far a joint may be from the centre, in travels
  std::vector<Eigen::Isometry3d> poses_;  // of the links, in the centre
};
}  // namespace gpu_planning_scene::core
