#include "collision/bounds/state_box.h"

#include <algorithm>

// A body's distance from a joint's axis depends only on the joints between the two. In the centre of the box it is
// computed. Elsewhere in the box it is larger by at most the length by which these joints move the body on the way from
// the centre. A bound of this length is known already, because the bounds are computed from the body upwards. Own
// method.
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
  sums[0] = 0.0;
  for (std::size_t i = 0; i < chain.steps.size(); ++i)
  {
    const LeverChain::Step& step = chain.steps[i];
    double displacement = 0.0;
    if (step.type != JointType::Fixed)
    {
      const JointTravel& travel = travel_[step.joint];
      displacement = travel.length;
      if (travel.angle != 0.0)  // zero times an infinite arm is no number, and an arm that is not needed takes time
        displacement += armOf(chain, step, beyond) * travel.angle;
      beyond += displacement * reach_;
    }
    sums[i + 1] = sums[i] + displacement;
  }
}
}  // namespace gpu_planning_scene::core
