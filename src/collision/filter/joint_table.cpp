#include "collision/filter/joint_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "collision/filter/moving_pair.h"
#include "collision/geometry/cpu_box_pair.h"
#include "model/math_constants.h"

// The range of the variables is halved until a box of joint values is proven to be apart or colliding, or is a single
// cell. If the surfaces stay apart in a whole box, containment cannot change within it either, so the middle of the box
// decides about containment.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kCellsOfOne = 1024;
constexpr int kCellsOfTwo = 256;
constexpr double kWiden = 1e-3;  // boxes are wider than their cells by this share, against rounding of the lookup
constexpr double kLargestMove =
    0.5;  // metres: boxes with larger displacements prove nothing, so they are halved at once
constexpr double kBallMargin = 1e-8;  // metres: exceeds the rounding error of distances

/// The joints between two links, from the first link to the second.
std::vector<int> jointsBetween(const RobotModel& robot, int from, int to)
{
  const auto upwards = [&robot](int link)
  {
    std::vector<int> joints;
    while (link >= 0 && robot.links()[static_cast<std::size_t>(link)].parent_joint >= 0)
    {
      joints.push_back(robot.links()[static_cast<std::size_t>(link)].parent_joint);
      link = robot.joints()[static_cast<std::size_t>(joints.back())].parent_link;
    }
    return joints;
  };
  std::vector<int> path = upwards(from);
  std::vector<int> other = upwards(to);
  while (!path.empty() && !other.empty() && path.back() == other.back())
  {
    path.pop_back();
    other.pop_back();
  }
  path.insert(path.end(), other.rbegin(), other.rend());
  return path;
}

/// The range of a variable that moves `joints`; no value: the variable has no usable range.
std::optional<TableVariable> rangeOf(const RobotModel& robot, int number, const std::vector<const Joint*>& joints)
{
  const Variable& variable = robot.variables()[static_cast<std::size_t>(number)];
  const auto is_turning = [number](const Joint* joint)
  {
    return joint->first_variable != number ||
           (joint->type != JointType::Prismatic && std::abs(joint->multiplier) == 1.0);
  };
  const bool wraps = std::all_of(joints.begin(), joints.end(), is_turning) &&
                     (!variable.bounded || variable.upper - variable.lower >= 2.0 * kPi);
  if (!wraps && !variable.bounded)
    return std::nullopt;
  const double slack = wraps ? 0.0 : 1e-6 * (variable.upper - variable.lower) + 1e-9;
  const double lower = wraps ? -kPi : variable.lower - slack;
  const double upper = wraps ? kPi : variable.upper + slack;
  return TableVariable{number, wraps, lower, upper - lower, 1};
}

class TableMaker
{
 public:
  TableMaker(const RobotModel& robot, const TableBody& a, const TableBody& b, const CpuShapePair& pairs)
    : robot_(robot), a_(a), b_(b), pairs_(pairs), state_(robot.defaultState()), poses_(robot.links().size())
  {
    for (const int joint : jointsBetween(robot, a.instance->link, b.instance->link))
      if (robot.joints()[static_cast<std::size_t>(joint)].type != JointType::Fixed)
        joints_.push_back(&robot.joints()[static_cast<std::size_t>(joint)]);
  }

  std::optional<JointTable> make()
  {
    for (const Joint* joint : joints_)
    {
      if (joint->type == JointType::Planar || joint->type == JointType::Floating)
        return std::nullopt;
      const auto is_known = [joint](const TableVariable& known) { return known.variable == joint->first_variable; };
      if (std::any_of(table_.variables.begin(), table_.variables.end(), is_known))
        continue;
      const std::optional<TableVariable> range = rangeOf(robot_, joint->first_variable, joints_);
      if (!range || table_.variables.size() == 2)
        return std::nullopt;
      table_.variables.push_back(*range);
    }
    if (table_.variables.empty())
      return std::nullopt;
    Box all{{0, 0}, {1, 1}};
    for (std::size_t k = 0; k < table_.variables.size(); ++k)
    {
      TableVariable& variable = table_.variables[k];
      variable.cells = table_.variables.size() == 1 ? kCellsOfOne : kCellsOfTwo;
      variable.cell_width /= variable.cells;
      all.end[k] = variable.cells;
    }
    table_.cells.assign(static_cast<std::size_t>(all.end[0]) * static_cast<std::size_t>(all.end[1]), Proof::None);
    fill(all);
    return std::move(table_);
  }

 private:
  /// A half-open range of cells.
  struct Box
  {
    std::array<int, 2> begin;
    std::array<int, 2> end;
  };

  void fill(const Box& box)
  {
    const Proof proof = proofOf(box);
    const std::array<int, 2> sizes = {box.end[0] - box.begin[0], box.end[1] - box.begin[1]};
    if (proof != Proof::None)
    {
      for (int i = box.begin[0]; i < box.end[0]; ++i)
        for (int j = box.begin[1]; j < box.end[1]; ++j)
          table_.cells[static_cast<std::size_t>(i) * (table_.variables.size() == 1 ? 1U : kCellsOfTwo) +
                       static_cast<std::size_t>(j)] = proof;
      return;
    }
    if (sizes[0] == 1 && sizes[1] == 1)
      return;
    const std::size_t longer = sizes[0] >= sizes[1] ? 0 : 1;
    Box first = box;
    Box second = box;
    first.end[longer] = second.begin[longer] = box.begin[longer] + sizes[longer] / 2;
    fill(first);
    fill(second);
  }

  Proof proofOf(const Box& box)
  {
    std::array<double, 2> travel = {0.0, 0.0};
    for (std::size_t k = 0; k < table_.variables.size(); ++k)
    {
      const TableVariable& variable = table_.variables[k];
      state_[static_cast<std::size_t>(variable.variable)] =
          variable.lower + 0.5 * variable.cell_width * (box.begin[k] + box.end[k]);
      travel[k] = (0.5 + kWiden) * variable.cell_width * (box.end[k] - box.begin[k]);
    }
    robot_.linkPoses(state_.data(), poses_.data());
    const Isometry3d pose_a = poses_[static_cast<std::size_t>(a_.instance->link)] * a_.instance->pose;
    const Isometry3d pose_b = poses_[static_cast<std::size_t>(b_.instance->link)] * b_.instance->pose;
    const std::vector<JointAxis> axes = axesIn(pose_a, travel);
    const Isometry3d b_in_a = relativePose(pose_a, pose_b);
    if (displacementBound(axes, b_in_a * b_.tree->center, 0.0) > kLargestMove)
      return Proof::None;
    if (innerBallsMeet(b_in_a, axes) || penetrates(b_, a_, b_in_a, axes) ||
        penetrates(a_, b_, b_in_a.inverse(), seenFrom(b_in_a, axes)))
      return Proof::Colliding;
    if (surfacesApartWhileMoving(*a_.tree, *b_.tree, b_in_a, axes, a_.sagitta + b_.sagitta) &&
        !pairs_.collide(a_.instance->tree, pose_a, b_.instance->tree, pose_b, 0.0, scratch_))
      return Proof::Apart;
    return Proof::None;
  }

  std::vector<JointAxis> axesIn(const Isometry3d& frame, const std::array<double, 2>& travel) const
  {
    std::vector<JointAxis> axes;
    for (const Joint* joint : joints_)
    {
      const std::size_t k = joint->first_variable == table_.variables[0].variable ? 0 : 1;
      const Isometry3d parent =
          joint->parent_link < 0 ? Isometry3d::Identity() : poses_[static_cast<std::size_t>(joint->parent_link)];
      const Isometry3d origin = relativePose(frame, parent * joint->origin);
      axes.push_back({joint->type == JointType::Prismatic, origin.translation(),
                      (origin.linear() * joint->axis).normalized(), std::abs(joint->multiplier) * travel[k]});
    }
    return axes;
  }

  /// Whether an inner ball of one shape meets an inner ball of the other wherever the joints are within their travel.
  bool innerBallsMeet(const Isometry3d& b_in_a, const std::vector<JointAxis>& axes) const
  {
    for (const CoverBall& ball : b_.cover->levels.back())
    {
      const Vector3d center = b_in_a * ball.witness;
      const double reach = ball.inner - displacementBound(axes, center, 0.0) - kBallMargin;
      for (const CoverBall& other : a_.cover->levels.back())
        if ((other.witness - center).norm() < other.inner + reach)
          return true;
    }
    return false;
  }

  /// The axes between the bodies, in the order from the second body to the first, in the frame of the second body.
  static std::vector<JointAxis> seenFrom(const Isometry3d& b_in_a, const std::vector<JointAxis>& axes)
  {
    const Isometry3d a_in_b = b_in_a.inverse();
    std::vector<JointAxis> seen(axes.rbegin(), axes.rend());
    for (JointAxis& axis : seen)
    {
      axis.point = a_in_b * axis.point;
      axis.direction = a_in_b.linear() * axis.direction;
    }
    return seen;
  }

  /// Whether a point of `body` stays inside the solid of `other` wherever the joints are within their travel. `pose`:
  /// of the body in the frame of the other one, for the middle values.
  static bool penetrates(const TableBody& body, const TableBody& other, const Isometry3d& pose,
                         const std::vector<JointAxis>& axes)
  {
    const auto is_inside = [&](const Vector3d& point)
    {
      const double depth = other.depth->at(pose * point);
      return depth > kBallMargin && depth > displacementBound(axes, pose * point, 0.0) + kBallMargin;
    };
    return std::any_of(body.depth->points().begin(), body.depth->points().end(), is_inside);
  }

  const RobotModel& robot_;
  const TableBody& a_;
  const TableBody& b_;
  const CpuShapePair& pairs_;
  std::vector<const Joint*> joints_;  // between the bodies, without fixed joints
  JointTable table_;
  std::vector<double> state_;
  std::vector<Isometry3d> poses_;
  CpuShapePair::Scratch scratch_;
};
}  // namespace

std::optional<JointTable> makeJointTable(const RobotModel& robot, const TableBody& a, const TableBody& b,
                                         const CpuShapePair& pairs)
{
  return TableMaker(robot, a, b, pairs).make();
}
}  // namespace gpu_planning_scene::core
