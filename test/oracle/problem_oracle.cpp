#include "oracle/problem_oracle.h"

#include <algorithm>

namespace gpu_planning_scene::core::oracle
{
namespace
{
/// Rodrigues' formula. The axis is normalised first.
Motion rotation(const Vector& axis, Quad angle)
{
  const Vector unit = (1 / length(axis)) * axis;
  const auto [sine, cosine] = sineCosine(angle);
  const std::array<Vector, 3> directions = {Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1)};
  std::array<Vector, 3> columns;
  for (int i = 0; i < 3; ++i)
  {
    const Vector along = dot(unit, directions[i]) * unit;
    columns[i] = along + cosine * (directions[i] - along) + sine * cross(unit, directions[i]);
  }
  Motion result;
  result.rows = columns;
  return result.inverse();
}

Motion shift(const Vector& translation)
{
  Motion result;
  result.translation = translation;
  return result;
}

/// A motion in the plane of a normal. The x axis is the coordinate direction that follows the one nearest to the
/// normal, projected into the plane. The y axis is perpendicular to x and the normal.
Motion planar(const Eigen::Vector3d& axis, const double* variables)
{
  int nearest;
  axis.cwiseAbs().maxCoeff(&nearest);
  const Vector next(Eigen::Vector3d(Eigen::Vector3d::Unit((nearest + 1) % 3)));
  const Vector normal = (1 / length(Vector(axis))) * Vector(axis);
  const Vector in_plane = next - dot(next, normal) * normal;
  const Vector x = (1 / length(in_plane)) * in_plane;
  return shift(Quad(variables[0]) * x + Quad(variables[1]) * cross(normal, x)) * rotation(normal, variables[2]);
}

/// A translation and the quaternion (q, w) = (x, y, z, w). It rotates v to v + 2 (w q x v + q x (q x v)) / |(q, w)|^2.
/// A quaternion of 0 does not rotate.
Motion floating(const double* variables)
{
  const Vector q(variables[3], variables[4], variables[5]);
  const Quad w = variables[6];
  const Quad squared = squaredLength(q) + w * w;
  Motion result;
  if (squared > 0)
  {
    std::array<Vector, 3> columns = {Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1)};
    for (Vector& v : columns)
    {
      const Vector turned = cross(q, v);
      v = v + (2 / squared) * (w * turned + cross(q, turned));
    }
    result.rows = columns;
    result = result.inverse();
  }
  result.translation = Vector(variables[0], variables[1], variables[2]);
  return result;
}

Motion jointMotion(const Joint& joint, const double* state)
{
  const auto position = [&] { return Quad(joint.multiplier) * state[joint.first_variable] + joint.offset; };
  switch (joint.type)
  {
    case JointType::Revolute:
    case JointType::Continuous:
      return rotation(Vector(joint.axis), position());
    case JointType::Prismatic:
      return shift(position() * Vector(joint.axis));
    case JointType::Planar:
      return planar(joint.axis, state + joint.first_variable);
    case JointType::Floating:
      return floating(state + joint.first_variable);
    case JointType::Fixed:
      break;
  }
  return {};
}
}  // namespace

std::vector<Motion> linkPoses(const RobotModel& robot, const double* state)
{
  std::vector<Motion> poses(robot.links().size());
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    const int number = robot.links()[i].parent_joint;
    if (number < 0)
      continue;
    const Joint& joint = robot.joints()[number];
    poses[i] = Motion(joint.origin) * jointMotion(joint, state);
    if (joint.parent_link >= 0)
      poses[i] = poses[joint.parent_link] * poses[i];
  }
  return poses;
}

struct ProblemOracle::Impl
{
  std::shared_ptr<const CollisionProblem> problem;
  std::vector<std::unique_ptr<PreparedShape>> shapes;       // one per tree
  std::vector<std::unique_ptr<PreparedShape>> half_spaces;  // in the planning frame
  std::vector<Motion> robot;                                // in the link's frame
  std::vector<Motion> world;

  struct Placed
  {
    const PreparedShape* shape;
    Motion pose;
    double padding;
    std::int32_t body;
  };

  Placed robotInstance(const std::vector<Motion>& link_poses, std::size_t i) const
  {
    const ShapeInstance& instance = problem->robot[i];
    return {shapes[instance.tree].get(), link_poses[instance.link] * robot[i], instance.padding, instance.body};
  }

  Placed worldInstance(std::size_t i) const
  {
    if (i < problem->world.size())
      return {shapes[problem->world[i].tree].get(), world[i], problem->world[i].padding, problem->world[i].body};
    i -= problem->world.size();
    return {half_spaces[i].get(), {}, problem->half_spaces[i].padding, problem->half_spaces[i].body};
  }

  /// Calls visit(a, b, required distance) for the checked pairs until it returns true.
  template <class Visit>
  void visitPairs(const std::vector<Motion>& link_poses, const Visit& visit) const
  {
    std::vector<Placed> moved;
    for (std::size_t i = 0; i < robot.size(); ++i)
      moved.push_back(robotInstance(link_poses, i));
    const std::size_t objects = problem->world.size();
    const std::size_t planes = problem->half_spaces.size();
    for (std::size_t i = 0; i < moved.size(); ++i)
    {
      for (std::size_t k = 0; k < objects + planes; ++k)
      {
        const bool checked = k < objects ? problem->world_pairs[i * objects + k] != 0
                                         : problem->half_space_pairs[i * planes + k - objects] != 0;
        if (!checked)
          continue;
        const Placed other = worldInstance(k);
        if (visit(moved[i], other, moved[i].padding + other.padding))
          return;
      }
    }
    for (const auto& [first, second] : problem->self_pairs)
      if (visit(moved[first], moved[second], 0.0))
        return;
  }
};

ProblemOracle::ProblemOracle(std::shared_ptr<const CollisionProblem> problem)
{
  auto impl = std::make_unique<Impl>();
  for (const Shape& shape : problem->shapes)
    impl->shapes.push_back(std::make_unique<PreparedShape>(shape));
  for (const WorldHalfSpace& plane : problem->half_spaces)
    impl->half_spaces.push_back(std::make_unique<PreparedShape>(HalfSpace{plane.normal, plane.offset}));
  for (const ShapeInstance& instance : problem->robot)
    impl->robot.emplace_back(instance.pose);
  for (const ShapeInstance& instance : problem->world)
    impl->world.emplace_back(instance.pose);
  impl->problem = std::move(problem);
  impl_ = std::move(impl);
}

ProblemOracle::~ProblemOracle() = default;

Verdict ProblemOracle::verdict(const std::vector<Motion>& link_poses) const
{
  Verdict worst = Verdict::Free;
  impl_->visitPairs(link_poses,
                    [&](const Impl::Placed& a, const Impl::Placed& b, double required)
                    {
                      const Verdict one = oracle::verdict(*a.shape, a.pose, *b.shape, b.pose, required);
                      if (one != Verdict::Free)
                        worst = one;
                      return worst == Verdict::Collides;
                    });
  return worst;
}

double ProblemOracle::clearance(const std::vector<Motion>& link_poses, double limit) const
{
  impl_->visitPairs(link_poses,
                    [&](const Impl::Placed& a, const Impl::Placed& b, double required)
                    {
                      const double found = distance(*a.shape, a.pose, *b.shape, b.pose, limit + required);
                      limit = std::min(limit, found - required);
                      return false;
                    });
  return limit;
}

std::map<BodyPair, double> ProblemOracle::clearances(const std::vector<Motion>& link_poses, double limit) const
{
  std::map<BodyPair, double> found;
  impl_->visitPairs(link_poses,
                    [&](const Impl::Placed& a, const Impl::Placed& b, double required)
                    {
                      const BodyPair bodies = {std::min(a.body, b.body), std::max(a.body, b.body)};
                      const auto known = found.find(bodies);
                      const double most = known == found.end() ? limit : known->second;
                      const double clearance = distance(*a.shape, a.pose, *b.shape, b.pose, most + required) - required;
                      if (clearance < most)
                        found[bodies] = clearance;
                      return false;
                    });
  return found;
}

double ProblemOracle::clearanceOf(const BodyPair& bodies, const std::vector<Motion>& link_poses, double limit) const
{
  impl_->visitPairs(link_poses,
                    [&](const Impl::Placed& a, const Impl::Placed& b, double required)
                    {
                      if (std::min(a.body, b.body) == bodies[0] && std::max(a.body, b.body) == bodies[1])
                        limit =
                            std::min(limit, distance(*a.shape, a.pose, *b.shape, b.pose, limit + required) - required);
                      return false;
                    });
  return limit;
}

Verdict ProblemOracle::pairVerdict(const std::vector<Motion>& link_poses, std::size_t first, std::size_t second) const
{
  const Impl& impl = *impl_;
  const Impl::Placed a = impl.robotInstance(link_poses, first);
  const bool self = second < impl.robot.size();
  const Impl::Placed b = self ? impl.robotInstance(link_poses, second) : impl.worldInstance(second - impl.robot.size());
  return oracle::verdict(*a.shape, a.pose, *b.shape, b.pose, self ? 0.0 : a.padding + b.padding);
}
}  // namespace gpu_planning_scene::core::oracle
