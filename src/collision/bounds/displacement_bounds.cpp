#include "collision/bounds/displacement_bounds.h"

#include <algorithm>
#include <limits>

#include "collision/bounds/reach.h"

// Each robot instance gets one term for each joint between its link and the root; a self pair gets the terms of the
// joints that move only one of the two (Schwarzer, Saha, Latombe 2002).
namespace gpu_planning_scene::core
{
namespace
{
// Exceeds the rounding of forward kinematics and distances in double within a kilometre.
constexpr double kDisplacementRounding = 1e-8;  // metres

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
}  // namespace

DisplacementBounds::DisplacementBounds(const RobotModel& robot, const CollisionProblem& problem)
  : joints_(robot.joints().size()), variables_(robot.variables().size()), ranges_(limitRanges(robot))
{
  const Reach reach(robot);
  // The terms of each instance, from its own link up to the root.
  struct Step
  {
    int link;
    Term term;
  };
  std::vector<std::vector<Step>> chains;
  for (const ShapeInstance& instance : problem.robot)
  {
    const SweptBody body = reach.sweep({PlacedShape{problem.shapes[instance.tree], Eigen::Isometry3d::Identity()}},
                                       instance.pose, instance.link);
    std::vector<Step> chain;
    int link = instance.link;
    for (std::size_t above = 0; link >= 0; ++above)
    {
      const int number = robot.links()[static_cast<std::size_t>(link)].parent_joint;
      Term term{number, 0.0, 0.0};
      if (number >= 0)
      {
        const Joint& joint = robot.joints()[static_cast<std::size_t>(number)];
        if (joint.type != JointType::Fixed)
          term = {number, 1.0,
                  above < body.region_by_level.size() ? armOf(joint, body.region_by_level[above]) : kUnbounded};
      }
      chain.push_back({link, term});
      link = number < 0 ? -1 : robot.joints()[static_cast<std::size_t>(number)].parent_link;
    }
    chains.push_back(std::move(chain));
  }
  const auto add = [&](const std::vector<Step>& chain, const std::vector<Step>& other)
  {
    for (const Step& step : chain)
    {
      if (std::any_of(other.begin(), other.end(), [&](const Step& theirs) { return theirs.link == step.link; }))
        break;  // joints further up move both instances
      if (step.term.length != 0.0)
        terms_.push_back(step.term);
    }
  };
  first_.push_back(0);
  for (const auto& chain : chains)
  {
    add(chain, {});
    first_.push_back(terms_.size());
  }
  for (const auto& [a, b] : problem.self_pairs)
  {
    add(chains[a], chains[b]);
    add(chains[b], chains[a]);
    first_.push_back(terms_.size());
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
      const JointTravel& joint = travel[terms_[k].joint];
      sum += terms_[k].length * joint.length;
      if (joint.angle != 0.0)
        sum += terms_[k].angle * joint.angle;
    }
    margins[i] = sum == 0.0 ? 0.0 : std::min(kLargestLength, sum * (1.0 + 1e-9) + kDisplacementRounding);
  }
}
}  // namespace gpu_planning_scene::core
