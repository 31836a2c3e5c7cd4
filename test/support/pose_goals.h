#pragma once

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/robot_model.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core
{
constexpr double kPoseTolerance = 1e-6;  // metres and radians

/// The link's own frame has the pose.
inline KinematicConstraints poseGoal(int link, const Eigen::Isometry3d& pose,
                                     double orientation_tolerance = kPoseTolerance)
{
  return KinematicConstraints::pose(link, Eigen::Isometry3d::Identity(), pose, kPoseTolerance, orientation_tolerance);
}

/// With any orientation.
inline KinematicConstraints positionGoal(int link, const Eigen::Vector3d& position)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  return poseGoal(link, pose, M_PI);
}

inline void expectPose(const RobotModel& robot, int link, const std::vector<double>& state,
                       const Eigen::Isometry3d& wanted)
{
  const Eigen::Isometry3d reached = linkPose(robot, link, state.data());
  EXPECT_LT((reached.translation() - wanted.translation()).norm(), kPoseTolerance);
  EXPECT_LT(Eigen::AngleAxisd(wanted.linear().transpose() * reached.linear()).angle(), kPoseTolerance);
}
}  // namespace gpu_planning_scene::core
