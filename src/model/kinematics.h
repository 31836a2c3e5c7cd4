#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Forward kinematics, laid out flat for speed: one step per link, parents first.
class Kinematics
{
 public:
  Kinematics(const std::vector<Link>& links, const std::vector<Joint>& joints);

  void linkPoses(const double* state, Eigen::Isometry3d* poses) const;

 private:
  /// Where a link is relative to its parent link, as a function of its joint's position q. With the joint's origin O,
  /// its axis a, and Rodrigues' formula R = a a^T + cos q (I - a a^T) + sin q [a]x:
  ///   revolute, continuous: constant + cos q first + sin q second  (O a a^T, O (I - a a^T), O [a]x)
  ///   prismatic:            constant + q first                     (O, and O a as a translation)
  ///   fixed:                constant                               (O)
  ///   planar, floating:     constant times what the variables say  (O; `first` holds the planar directions)
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

  std::vector<Step> steps_;
};
}  // namespace gpu_planning_scene::core
