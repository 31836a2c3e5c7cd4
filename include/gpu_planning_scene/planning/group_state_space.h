#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <ompl/base/StateSpace.h>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The state space of a planning group of the SRDF, for OMPL: the variables of its active joints. A compound of
///  - one RealVectorStateSpace of all revolute and prismatic joints, its dimensions named after them, with their
///  limits,
///  - an SO2StateSpace for each continuous joint,
///  - an SE2StateSpace for each planar joint and an SE3StateSpace for each floating one, whose translations are bounded
///    by Variable::lower and upper,
/// in this order, each named after its joint. Mimic joints follow their leaders; passive joints, and those whose limits
/// leave them no room, are not planned for.
class GroupStateSpace : public ompl::base::CompoundStateSpace
{
 public:
  /// Its name is the group's. Throws Error for an unknown group, for one without a joint to plan for, for a planar or
  /// floating joint of it whose translations have no room, and for a continuous one that hasNoPeriod.
  GroupStateSpace(std::shared_ptr<const RobotModel> robot, const std::string& group);

  const std::shared_ptr<const RobotModel>& robot() const { return robot_; }
  const Group& group() const { return *group_; }
  /// The robot's variables that are planned for: one per value of a state, in the order of getValueLocations().
  const std::vector<int>& variables() const { return variables_; }

  /// Writes a state into a row of all variables of the robot; the others stay as they are.
  void copyToRow(const ompl::base::State* state, double* row) const;
  /// The other way round. Angles of continuous and planar joints are brought to [-pi, pi), quaternions to unit length;
  /// one of zero length means no rotation.
  void copyFromRow(const double* row, ompl::base::State* state) const;

  /// The default projection becomes that onto these joints: their positions, of planar and floating ones the
  /// translations. Without this it is that onto the first of the joints with limits, at most three, as those near the
  /// root move the most; where there are none, onto the first planar or floating joint, else the first continuous one.
  /// Throws Error and changes nothing for no joint, and for one that is not in the space. To be followed by setup().
  void projectOnto(const std::vector<std::string>& joints);
  void registerProjections() override;

  /// As the compound's, but within bounds: OMPL's SO2StateSpace may give an angle of pi, which is out of its own.
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;

 private:
  std::vector<std::size_t> projectedValues(const std::vector<std::string>& joints) const;

  std::shared_ptr<const RobotModel> robot_;
  const Group* group_;
  std::vector<int> variables_;
  std::vector<std::size_t> angles_;     // which of the values are in an SO2StateSpace
  std::vector<std::size_t> rotations_;  // which of the values are the x of a quaternion
  std::vector<std::size_t> projected_;  // which of the values the default projection keeps
};
}  // namespace gpu_planning_scene::core
