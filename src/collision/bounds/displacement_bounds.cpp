#include "collision/bounds/displacement_bounds.h"

#include <algorithm>
#include <limits>

#include "collision/bounds/displacement_rounding.h"
#include "collision/bounds/reach.h"

// Each robot instance gets one lever for each joint between its link and the root; a self pair gets the levers of the
// joints that move only one of the two (Schwarzer, Saha, Latombe 2002).
namespace gpu_planning_scene::core
{
namespace
{
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

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

JointLevers::Chain chainOf(const RobotModel& robot, const Reach& reach, const Shape& shape,
                           const ShapeInstance& instance)
{
  const SweptBody body = reach.sweep({PlacedShape{shape, Eigen::Isometry3d::Identity()}}, instance.pose, instance.link);
  JointLevers::Chain chain;
  int link = instance.link;
  for (std::size_t above = 0; link >= 0; ++above)
  {
    const int number = robot.links()[static_cast<std::size_t>(link)].parent_joint;
    if (number < 0)
    {
      chain.steps.push_back({link, std::nullopt});
      break;
    }
    const Joint& joint = robot.joints()[static_cast<std::size_t>(number)];
    std::optional<JointLever> lever;
    if (joint.type != JointType::Fixed)
      lever = {number, 1.0,
               above < body.region_by_level.size() ? armOf(joint, body.region_by_level[above]) : kUnbounded};
    chain.steps.push_back({link, lever});
    link = joint.parent_link;
  }
  return chain;
}
}  // namespace

std::vector<std::shared_ptr<const JointLevers::Chain>> JointLevers::of(const std::shared_ptr<const RobotModel>& robot,
                                                                       const CollisionProblem& problem)
{
  if (robot != robot_)
    known_.clear();
  robot_ = robot;
  std::optional<Reach> reach;
  std::vector<Known> used;
  std::vector<std::shared_ptr<const Chain>> chains;
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
                      std::make_shared<const Chain>(chainOf(*robot, *reach, shape, instance))});
    }
    chains.push_back(used.back().chain);
  }
  known_ = std::move(used);
  return chains;
}

DisplacementBounds::DisplacementBounds(const std::shared_ptr<const RobotModel>& robot, const CollisionProblem& problem,
                                       JointLevers& levers)
  : joints_(robot->joints().size()), variables_(robot->variables().size()), ranges_(provenRanges(*robot))
{
  const std::vector<std::shared_ptr<const JointLevers::Chain>> chains = levers.of(robot, problem);
  const auto add = [&](const JointLevers::Chain& chain, const JointLevers::Chain& other)
  {
    for (const auto& [link, lever] : chain.steps)
    {
      if (std::any_of(other.steps.begin(), other.steps.end(),
                      [link = link](const JointLevers::Chain::Step& theirs) { return theirs.link == link; }))
        break;  // joints further up move both instances
      if (lever)
        levers_.push_back(*lever);
    }
  };
  first_.push_back(0);
  for (const auto& chain : chains)
  {
    add(*chain, {});
    first_.push_back(levers_.size());
  }
  for (const auto& [a, b] : problem.self_pairs)
  {
    add(*chains[a], *chains[b]);
    add(*chains[b], *chains[a]);
    first_.push_back(levers_.size());
  }
}

Margins DisplacementBounds::margins(const JointNeighbourhood& around, const double* states, std::size_t count) const
{
  const std::size_t rows = joints_ == 0 ? 0 : around.travel.size() / joints_;
  Margins result{this->count(), std::vector<double>(rows * this->count()), around.rows, {}};
  for (std::size_t row = 0; row < rows; ++row)
    margins(around.travel.data() + row * joints_, result.values.data() + row * this->count());
  result.within.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    result.within.push_back(withinRanges(ranges_, states + i * variables_) ? 1 : 0);
  return result;
}

void DisplacementBounds::margins(const JointTravel* travel, double* margins) const
{
  for (std::size_t i = 0; i + 1 < first_.size(); ++i)
  {
    double sum = 0.0;
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
    {
      const JointTravel& joint = travel[levers_[k].joint];
      sum += levers_[k].per_metre * joint.length;
      if (joint.angle != 0.0)
        sum += levers_[k].per_radian * joint.angle;
    }
    margins[i] = sum == 0.0 ? 0.0 : std::min(kLargestMargin, withRounding(sum));
  }
}
}  // namespace gpu_planning_scene::core
