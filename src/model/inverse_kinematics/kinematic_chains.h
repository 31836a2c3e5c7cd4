#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"
#include "model/inverse_kinematics/degrees_of_freedom.h"

namespace gpu_planning_scene::core
{
/// The joints between the root and some links, with the degrees of freedom that belong to a group. Immutable and
/// thread-safe; each thread needs its own Workspace.
class KinematicChains
{
 public:
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  struct Workspace
  {
    std::vector<Eigen::Isometry3d> poses;  ///< of the links and of those between them and the root
    std::vector<std::uint8_t> known;
  };

  /// Throws Error if no variable of the group moves one of the links.
  KinematicChains(std::shared_ptr<const RobotModel> robot, const Group& group, const std::vector<int>& links);

  const RobotModel& robot() const { return *robot_; }
  const std::vector<int>& variables() const { return variables_; }
  const DegreesOfFreedom& degreesOfFreedom() const { return freedoms_; }

  /// Writes the poses of the links in the planning frame.
  void computePoses(const double* state, Workspace& workspace) const;

  /// The geometric Jacobian of a link at the state of the last call of computePoses(): one column per degree of
  /// freedom, with the velocity of the link's origin (three rows) and its angular velocity, in the planning frame.
  /// K. M. Lynch, F. C. Park: Modern Robotics, 2017, chapter 5.
  void jacobian(int link, const Workspace& workspace, Jacobian& columns) const;

 private:
  /// The motion of one joint by one degree of freedom.
  struct Motion
  {
    int freedom;
    int parent;  // link; -1: the planning frame
    int child;
    bool rotates;
    Eigen::Vector3d axis;  // rotations: in the child's frame; translations: in the parent's frame. Has the multiplier.
  };

  /// A link with the motions that move it.
  struct Chain
  {
    int link;
    std::vector<Motion> motions;
  };

  Chain chainTo(int link, const Group& group);
  void addMotions(const Joint& joint, std::vector<Motion>& motions);
  int addFreedom(int variable, int axis, bool is_turn);

  std::shared_ptr<const RobotModel> robot_;
  std::vector<Chain> chains_;
  std::vector<int> moving_links_;  // whose poses depend on the state
  std::vector<int> variables_;
  DegreesOfFreedom freedoms_;
};
}  // namespace gpu_planning_scene::core
