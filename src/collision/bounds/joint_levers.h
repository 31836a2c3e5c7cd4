#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/bounds/reach.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
constexpr double kUnboundedArm = std::numeric_limits<double>::infinity();

/// The most balls around an instance. More balls give tighter bounds, but a motion takes longer.
constexpr std::size_t kLeverBalls = 8;

/// How far the joints between the root and an instance can move the instance's points.
struct LeverChain
{
  struct Step
  {
    int link;   ///< the child link of the joint
    int joint;  ///< -1: the root link has no joint
    JointType type = JointType::Fixed;
    /// Metres per radian: the largest distance of the instance's points from the joint's axis, anywhere within the
    /// limits, or kUnboundedArm.
    double largest_arm = 0.0;
  };
  /// At most kLeverBalls balls that contain the instance, in the frame of its link. None if they are too large.
  std::vector<Ball> balls;
  std::vector<Step> steps;  ///< from the instance's link up to the root
};

/// The chains of a robot's instances. Computing them takes milliseconds, so they are kept for the next scene. One
/// caller at a time.
class JointLevers
{
 public:
  /// The chains of the problem's robot instances.
  std::vector<std::shared_ptr<const LeverChain>> of(const std::shared_ptr<const RobotModel>& robot,
                                                    const CollisionProblem& problem);

 private:
  struct Known
  {
    Shape shape;
    Eigen::Isometry3d pose;
    int link;
    std::shared_ptr<const LeverChain> chain;
  };

  std::shared_ptr<const RobotModel> robot_;
  std::vector<Known> known_;  // of the latest problem
};
}  // namespace gpu_planning_scene::core
