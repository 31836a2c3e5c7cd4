#pragma once

#include <memory>
#include <string>

#include <ompl/base/StateSpace.h>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene
{
/// The state space of a planning group of the SRDF, for OMPL: the variables of its active joints. A compound of
///  - one RealVectorStateSpace of all revolute and prismatic joints, its dimensions named after them, with their
///  limits,
///  - an SO2StateSpace for each continuous joint,
///  - an SE2StateSpace for each planar joint and an SE3StateSpace for each floating one, whose translations are bounded
///    by Variable::lower and upper,
/// in this order, each named after its joint. Mimic joints follow their leaders; passive joints are not planned for.
class GroupStateSpace : public ompl::base::CompoundStateSpace
{
 public:
  /// Its name is the group's. Throws Error for an unknown group, and for one without a variable.
  GroupStateSpace(std::shared_ptr<const RobotModel> robot, const std::string& group);

  const std::shared_ptr<const RobotModel>& robot() const;
  const Group& group() const;

  /// Writes a state into a row of all variables of the robot; the others stay as they are.
  void copyToRow(const ompl::base::State* state, double* row) const;
  /// The other way round. Angles of continuous and planar joints are brought to [-pi, pi).
  void copyFromRow(const double* row, ompl::base::State* state) const;
};
}  // namespace gpu_planning_scene
