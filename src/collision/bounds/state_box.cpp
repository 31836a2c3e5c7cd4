#include "collision/bounds/state_box.h"

#include <algorithm>
#include <cmath>

// The distance of a body from a joint's axis depends only on the joints between the axis and the body. It is known in
// the middle of the box. On the way from there to any state of the box, these joints change it by at most what they
// move the body, and this sum has the same form as the bound itself. So the sum is built from the body's joint upwards.
// Own method.
namespace gpu_planning_scene::core
{
namespace
{
// More than the rounding of kinematics in double within a kilometre of the origin.
constexpr double kArmRounding = 1e-9;  // metres, and relative to the arm
}  // namespace

StateBox::StateBox(const RobotModel& robot) : robot_(robot), half_(robot.joints().size()), poses_(robot.links().size())
{
}

void StateBox::set(const double* lower, const double* upper, const double* state, const JointTravel* travel)
{
  travel_ = travel;
  middle_.assign(state, state + robot_.variables().size());
  for (std::size_t i = 0; i < half_.size(); ++i)
  {
    const Joint& joint = robot_.joints()[i];
    half_[i] = travel[i].length + travel[i].angle;
    if (variableCount(joint.type) != 1)
      continue;
    const auto variable = static_cast<std::size_t>(joint.first_variable);
    middle_[variable] = 0.5 * (lower[variable] + upper[variable]);
    half_[i] += 0.5 * std::abs(joint.multiplier) * (upper[variable] - lower[variable]);
  }
  robot_.linkPoses(middle_.data(), poses_.data());
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
  double beyond = chain.balls.empty() ? kUnboundedArm : 0.0;
  *sums = 0.0;
  for (const LeverChain::Step& step : chain.steps)
  {
    double sum = *sums;
    if (step.type != JointType::Fixed)
    {
      const JointTravel& travel = travel_[step.joint];
      const double half = half_[static_cast<std::size_t>(step.joint)];
      // Zero times an infinite arm is no number, and an arm that is not needed takes time.
      const bool turns = step.type != JointType::Prismatic && (travel.angle != 0.0 || half != 0.0);
      const double arm = turns ? armOf(chain, step, beyond) : 1.0;
      sum += travel.length;
      if (travel.angle != 0.0)
        sum += arm * travel.angle;
      if (half != 0.0)
        beyond += arm * half;
      // How far a joint with several variables is from the middle is not known.
      if (variableCount(step.type) > 1)
        beyond = kUnboundedArm;
    }
    *++sums = sum;
  }
}
}  // namespace gpu_planning_scene::core
