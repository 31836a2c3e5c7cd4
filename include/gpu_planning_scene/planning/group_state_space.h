#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ompl/base/StateSpace.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The state space of a planning group of the SRDF, for OMPL. Its values are variables of the group's active joints, in
/// radians and metres. It is a compound of these spaces, in this order:
///   - one RealVectorStateSpace for all revolute and prismatic joints, with their limits; each dimension is named
///     after its joint,
///   - an SO2StateSpace for each continuous joint,
///   - an SE2StateSpace for each planar joint, with its translations bounded by Variable::lower and upper, and by the
///     workspace,
///   - an SE3StateSpace for each floating joint, with the same bounds.
/// The SO2, SE2 and SE3 spaces have the names of their joints. The space has no values for mimic joints (they follow
/// their leaders), for passive joints, or for joints whose limits leave no range. Const functions are thread-safe after
/// setup().
class GroupStateSpace : public ompl::base::CompoundStateSpace
{
 public:
  /// The space has the name of the group. Throws Error if the group is unknown or has no joint to plan for, if a planar
  /// or floating joint has no range for its translations, or if a continuous joint is not periodic (isPeriodic).
  /// `workspace`: the range of the translations of planar and floating joints, in metres, as workspace_parameters of
  /// MoveIt. It replaces RobotModelOptions::unbounded_translation, and narrows limits.
  GroupStateSpace(std::shared_ptr<const RobotModel> robot, const std::string& group,
                  const std::optional<Eigen::AlignedBox3d>& workspace = std::nullopt);

  const std::shared_ptr<const RobotModel>& robot() const { return robot_; }
  const Group& group() const { return *group_; }
  /// Indices of the robot's variables in this space: one per value of a state, in the order of getValueLocations().
  const std::vector<int>& variables() const { return variables_; }
  /// The lower and the upper bound of each of variables(); infinite for rotations and angles without limits.
  const std::vector<std::pair<double, double>>& ranges() const { return ranges_; }

  /// Writes the values of a state into a row of all variables of the robot. Other variables of the row keep their
  /// values.
  void copyToRow(const ompl::base::State* state, double* row) const;
  /// Sets a state from a row of all variables. Angles of continuous and planar joints are wrapped to [-pi, pi),
  /// quaternions are normalised; a quaternion of zero length becomes the identity.
  void copyFromRow(const double* row, ompl::base::State* state) const;

  /// Makes the values of these joints the default projection: positions of joints with one variable, translations of
  /// planar and floating joints. Without this call, the projection has the first joints with limits, at most three,
  /// because joints near the root move the most. If there are none, it has the first planar or floating joint, else the
  /// first continuous joint. Throws Error and changes nothing if `joints` is empty or names a joint that is not in the
  /// space. Call setup() afterwards.
  void projectOnto(const std::vector<std::string>& joints);
  void registerProjections() override;

  /// Interpolates as the compound space does, but keeps the result within the bounds: OMPL's SO2StateSpace can return
  /// an angle of pi, which is outside of its own bounds.
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;

 private:
  std::vector<std::size_t> projectedValues(const std::vector<std::string>& joints) const;

  std::shared_ptr<const RobotModel> robot_;
  const Group* group_;
  std::vector<int> variables_;
  std::vector<std::pair<double, double>> ranges_;
  std::vector<std::size_t> angles_;     // indices of the values in an SO2StateSpace
  std::vector<std::size_t> rotations_;  // indices of the values that are the x of a quaternion
  std::vector<std::size_t> projected_;  // indices of the values in the default projection
};
}  // namespace gpu_planning_scene::core
