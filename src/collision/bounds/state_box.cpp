#include "collision/bounds/state_box.h"

#include <algorithm>
#include <optional>

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

/// The balls of a chain with at least one ball in the centre of the box, in the planning frame. The places of missing
/// balls have the first ball again.
StateBox::PlacedBalls StateBox::place(const LeverChain& chain) const
{
  const Eigen::Isometry3d& body = poses_[static_cast<std::size_t>(chain.steps.front().link)];
  PlacedBalls balls;
  for (std::size_t i = 0; i < kLeverBalls; ++i)
  {
    const Ball& ball = chain.balls[i < chain.balls.size() ? i : 0];
    balls.centers.row(static_cast<Eigen::Index>(i)) = (body * ball.center).transpose();
    balls.radii[static_cast<Eigen::Index>(i)] = ball.radius;
  }
  return balls;
}

/// Metres: the largest distance of the balls' points from the axis of the step's joint in the box. `beyond`: the
/// largest displacement in the box of these points by the joints below.
double StateBox::armOf(const PlacedBalls& balls, const LeverChain::Step& step, double beyond) const
{
  const Eigen::Isometry3d& frame = poses_[static_cast<std::size_t>(step.link)];
  const PlacedBalls::Numbers x = balls.centers.col(0) - frame.translation().x();
  const PlacedBalls::Numbers y = balls.centers.col(1) - frame.translation().y();
  const PlacedBalls::Numbers z = balls.centers.col(2) - frame.translation().z();
  PlacedBalls::Numbers squared = x.square() + y.square() + z.square();
  if (step.type != JointType::Floating)  // a floating joint may turn about any axis through the origin
  {
    const Eigen::Vector3d axis = frame.linear() * robot_.joints()[static_cast<std::size_t>(step.joint)].axis;
    squared = (y * axis.z() - z * axis.y()).square() + (z * axis.x() - x * axis.z()).square() +
              (x * axis.y() - y * axis.x()).square();
  }
  const double arm = (squared.sqrt() + balls.radii).maxCoeff();
  return std::min(step.largest_arm, arm * (1.0 + kArmRounding) + kArmRounding + beyond);
}

void StateBox::sumSteps(const LeverChain& chain, double* sums) const
{
  std::optional<PlacedBalls> balls;  // placed for the first arm that is needed
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
      {
        const bool may_be_shorter = beyond < step.largest_arm;
        if (may_be_shorter && !balls)
          balls = place(chain);
        displacement += (may_be_shorter ? armOf(*balls, step, beyond) : step.largest_arm) * travel.angle;
      }
      beyond += displacement * reach_;
    }
    sums[i + 1] = sums[i] + displacement;
  }
}
}  // namespace gpu_planning_scene::core
