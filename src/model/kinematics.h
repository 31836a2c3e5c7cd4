#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Forward kinematics: one precomputed step per link, parents first, in a flat array for speed. Immutable and
/// thread-safe.
class Kinematics
{
 public:
  Kinematics(const std::vector<Link>& links, const std::vector<Joint>& joints);

  /// Writes the pose of each link in the planning frame: see RobotModel::linkPoses.
  void linkPoses(const double* state, Eigen::Isometry3d* poses) const;

  /// See RobotModel::computeLinkPose.
  void computeLinkPose(const double* state, int link, Eigen::Isometry3d* poses, std::uint8_t* known) const;

 private:
  /// Pose of a link relative to its parent link, as a function of the joint's position q (radians or metres). O is the
  /// origin of the joint, a its axis; rotations use Rodrigues' formula R = a a^T + cos q (I - a a^T) + sin q [a]x.
  ///   revolute, continuous: constant + cos q first + sin q second  (O a a^T, O (I - a a^T), O [a]x)
  ///   prismatic:            constant + q first                     (O, and O a as a translation)
  ///   fixed:                constant                               (O)
  ///   planar, floating:     constant times the joint's motion      (O; `first` holds the planar directions)
  struct Step
  {
    Eigen::Matrix4d constant = Eigen::Matrix4d::Identity();
    Eigen::Matrix4d first = Eigen::Matrix4d::Zero();
    Eigen::Matrix4d second = Eigen::Matrix4d::Zero();
    double multiplier = 1.0;
    double offset = 0.0;
    int parent = -1;
    int variable = -1;
    JointType type = JointType::Fixed;
  };

  static Eigen::Matrix4d relativePose(const Step& step, const double* state);
  static void place(const Step& step, const double* state, Eigen::Isometry3d* poses, Eigen::Isometry3d& pose);

  std::vector<Step> steps_;
};
}  // namespace gpu_planning_scene::core
