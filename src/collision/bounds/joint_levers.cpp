#include "collision/bounds/joint_levers.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

// Each robot instance has a step for each joint between its link and the root.
namespace gpu_planning_scene::core
{
namespace
{
/// The largest distance of a region from the joint's axis. The region is in the frame of the joint's child link.
double armOf(const Joint& joint, const Region& region)
{
  double arm = 0.0;
  for (const Ball& ball : region.balls)
  {
    // A floating joint may turn about any axis through the origin.
    const Eigen::Vector3d across =
        joint.type == JointType::Floating ? ball.center : ball.center - joint.axis.dot(ball.center) * joint.axis;
    arm = std::max(arm, across.norm() + ball.radius);
  }
  return arm;
}

LeverChain chainOf(const RobotModel& robot, const Reach& reach, const Shape& shape, const ShapeInstance& instance)
{
  const SweptBody body = reach.sweep({PlacedShape{shape, Eigen::Isometry3d::Identity()}}, instance.pose, instance.link);
  LeverChain chain;
  if (!body.region_by_level.empty())
    chain.balls = clustered(body.region_by_level.front().balls, kLeverBalls);
  if (chain.balls.size() > kLeverBalls)
    throw std::logic_error("an instance has more balls than kLeverBalls");
  int link = instance.link;
  for (std::size_t above = 0; link >= 0; ++above)
  {
    const int number = robot.links()[static_cast<std::size_t>(link)].parent_joint;
    chain.steps.push_back({link, number});
    if (number < 0)
      break;
    const Joint& joint = robot.joints()[static_cast<std::size_t>(number)];
    chain.steps.back().type = joint.type;
    chain.steps.back().largest_arm =
        above < body.region_by_level.size() ? armOf(joint, body.region_by_level[above]) : kUnboundedArm;
    link = joint.parent_link;
  }
  return chain;
}
}  // namespace

std::vector<std::shared_ptr<const LeverChain>> JointLevers::of(const std::shared_ptr<const RobotModel>& robot,
                                                               const CollisionProblem& problem)
{
  if (robot != robot_)
    known_.clear();
  robot_ = robot;
  std::optional<Reach> reach;
  std::vector<Known> used;
  std::vector<std::shared_ptr<const LeverChain>> chains;
  for (const ShapeInstance& instance : problem.robot)
  {
    const Shape& shape = problem.shapes[instance.tree];
    const auto is_it = [&](const Known& known)
    {
      return known.link == instance.link && known.pose.matrix() == instance.pose.matrix() &&
             sameShape(known.shape, shape);
    };
    const auto found = std::find_if(known_.begin(), known_.end(), is_it);
    if (found != known_.end())
      used.push_back(*found);
    else
    {
      if (!reach)
        reach.emplace(*robot);
      used.push_back({shape, instance.pose, instance.link,
                      std::make_shared<const LeverChain>(chainOf(*robot, *reach, shape, instance))});
    }
    chains.push_back(used.back().chain);
  }
  known_ = std::move(used);
  return chains;
}
}  // namespace gpu_planning_scene::core
