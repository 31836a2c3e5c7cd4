#include "collision/bounds/state_box.h"

#include <algorithm>
#include <cmath>

// The distance of a body from a joint's axis depends only on the joints between the axis and the body. It is known in
// the centre of the box. On the way from there to any state of the box, these joints change it by at most what they
// move the body, and this sum has the same form as the bound itself. So the sum is built from the body's joint upwards.
// Own method.
namespace gpu_planning_scene::core
{
namespace
{
// More than the rounding of kinematics in double within a kilometre of the origin.
constexpr double kArmRounding = 1e-9;  // metres, and relative to the arm
}  // namespace

StateBox::StateBox(const RobotModel& robot) : robot_(robot), poses_(robot.links().size()) {}

void StateBox::set(const double* center, const JointTravel* travel, double spread)
{
  travel_ = travel;
  reach_ = 1.0 + spread;
  has_center_ = center != nullptr;
  if (has_center_)
    robot_.linkPoses(center, poses_.data());
}

/// Metres: the largest distance of the instance's points from the axis of the step's joint in the box. `beyond`: the
/// largest displacement in the box of these points by the joints below.
double StateBox::armOf(const LeverChain& chain, const LeverChain::Step& step, double beyond) const
{
  if (!(beyond < step.largest_arm))
    return step.largest_arm;
  const Eigen::Isometry3d& body = poses_[static_cast<std::size_t>(chain.steps.front().link)];
  const Eigen::Isometry3d& frame = poses_[static_cast<std::size_t>(step.link)];
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  // a floating joint may turn about any axis through the origin
  if (step.type != JointType::Floating)
    axis = frame.linear() * robot_.joints()[static_cast<std::size_t>(step.joint)].axis;
  double arm = 0.0;
  for (const Ball& ball : chain.balls)
  {
    const Eigen::Vector3d center = body * ball.center - frame.translation();
    arm = std::max(arm, (center - axis.dot(center) * axis).norm() + ball.radius);
  }
  return std::min(step.largest_arm, arm * (1.0 + kArmRounding) + kArmRounding + beyond);
}

void StateBox::sumSteps(const LeverChain& chain, double* sums) const
{
  double beyond = has_center_ && !chain.balls.empty() ? 0.0 : kUnboundedArm;
  *sums = 0.0;
  for (const LeverChain::Step& step : chain.steps)
  {
    double sum = *sums;
    if (step.type != JointType::Fixed)
    {
      const JointTravel& travel = travel_[step.joint];
      double moved = travel.length;
      if (travel.angle != 0.0)  // zero times an infinite arm is no number, and an arm that is not needed takes time
        moved += armOf(chain, step, beyond) * travel.angle;
      sum += moved;
      beyond += moved * reach_;
    }
    *++sums = sum;
  }
}
}  // namespace gpu_planning_scene::core
