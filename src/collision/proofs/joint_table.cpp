#include "collision/proofs/joint_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <utility>

#include "collision/geometry/cpu_box_pair.h"
#include "collision/proofs/joint_chain.h"
#include "collision/proofs/moving_pair.h"

// The range of the variables is halved until a box of joint values is proven to be apart or colliding, or is a single
// cell. If the surfaces stay apart in a whole box, containment cannot change within it either, so the middle of the box
// decides about containment. Large boxes come first, so that they have their proofs if the steps run out. The halving
// is that of R. A. Brooks, T. Lozano-Perez: A subdivision algorithm in configuration space for findpath with rotation.
// IJCAI 1983.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kWiden = 1e-3;  // boxes are wider than their cells by this share, against rounding of the lookup
constexpr double kLargestMove =
    0.5;  // metres: boxes with larger displacements prove nothing, so they are halved at once
constexpr double kBallMargin = 1e-8;  // metres: exceeds the rounding error of distances

// The tests of balls and points in a box of joint values take as long as so many steps.
constexpr std::uint64_t kStepsOfBox = 200;

constexpr unsigned kPointsPerStopTest = 256;

class TableMaker
{
 public:
  TableMaker(const RobotModel& robot, const TableInstance& a, const TableInstance& b, const CpuShapePair& pairs,
             const Stopped& stopped, std::uint64_t most_steps)
    : robot_(robot),
      a_(a),
      b_(b),
      pairs_(pairs),
      stopped_(stopped),
      most_steps_(most_steps),
      state_(robot.defaultState()),
      poses_(robot.links().size())
  {
  }

  std::optional<JointTable> make()
  {
    const std::vector<ChainJoint> chain = jointsBetween(robot_, a_.instance->link, b_.instance->link);
    std::optional<std::vector<TableVariable>> variables = tableVariables(robot_, chain);
    if (!variables)
      return std::nullopt;
    for (const ChainJoint& part : chain)
      if (part.joint->type != JointType::Fixed)
        joints_.push_back(part.joint);
    table_.variables = std::move(*variables);
    Box all{{0, 0}, {1, 1}};
    for (std::size_t k = 0; k < table_.variables.size(); ++k)
      all.end[k] = table_.variables[k].cells;
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

  std::size_t columns() const
  {
    return table_.variables.size() == 1 ? 1U : static_cast<std::size_t>(table_.variables[1].cells);
  }

  void fill(const Box& all)
  {
    StopTest end_if_stopped(stopped_);
    std::deque<Box> open = {all};
    while (!open.empty() && steps_ < most_steps_)
    {
      end_if_stopped();
      const Box box = open.front();
      open.pop_front();
      const Proof proof = proofOf(box);
      const std::array<int, 2> sizes = {box.end[0] - box.begin[0], box.end[1] - box.begin[1]};
      if (proof != Proof::None)
        setCells(box, proof);
      else if (sizes[0] > 1 || sizes[1] > 1)
      {
        const std::size_t longer = sizes[0] >= sizes[1] ? 0 : 1;
        Box first = box;
        Box second = box;
        first.end[longer] = second.begin[longer] = box.begin[longer] + sizes[longer] / 2;
        open.push_back(first);
        open.push_back(second);
      }
    }
  }

  void setCells(const Box& box, Proof proof)
  {
    for (int i = box.begin[0]; i < box.end[0]; ++i)
      for (int j = box.begin[1]; j < box.end[1]; ++j)
        table_.cells[static_cast<std::size_t>(i) * columns() + static_cast<std::size_t>(j)] = proof;
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
    steps_ += kStepsOfBox;
    if (innerBallsMeet(b_in_a, axes) || penetrates(b_, a_, b_in_a, axes) ||
        penetrates(a_, b_, b_in_a.inverse(), seenFrom(b_in_a, axes)))
      return Proof::Colliding;
    if (!surfacesApartWhileMoving(*a_.tree, *b_.tree, b_in_a, axes, a_.sagitta + b_.sagitta, steps_, stopped_))
      return Proof::None;
    const std::uint64_t before = scratch_.steps;
    const bool collide = pairs_.collide(a_.instance->tree, pose_a, b_.instance->tree, pose_b, 0.0, scratch_);
    steps_ += scratch_.steps - before + componentsOf(*a_.tree).size() + componentsOf(*b_.tree).size();
    return collide ? Proof::None : Proof::Apart;
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

  /// Whether an inner ball of one shape meets an inner ball of the other shape for all joint values within the travel.
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

  /// Whether a point of `body` is inside the solid of `other` for all joint values within the travel. `pose`: of `body`
  /// in the frame of `other`, for the middle values.
  bool penetrates(const TableInstance& body, const TableInstance& other, const Isometry3d& pose,
                  const std::vector<JointAxis>& axes) const
  {
    StopTest end_if_stopped(stopped_, kPointsPerStopTest);
    const auto is_inside = [&](const Vector3d& point)
    {
      end_if_stopped();
      const double depth = other.depth->at(pose * point);
      return depth > kBallMargin && depth > displacementBound(axes, pose * point, 0.0) + kBallMargin;
    };
    return std::any_of(body.depth->points().begin(), body.depth->points().end(), is_inside);
  }

  const RobotModel& robot_;
  const TableInstance& a_;
  const TableInstance& b_;
  const CpuShapePair& pairs_;
  const Stopped& stopped_;
  const std::uint64_t most_steps_;
  std::uint64_t steps_ = 0;
  std::vector<const Joint*> joints_;  // between the bodies, without fixed joints
  JointTable table_;
  std::vector<double> state_;
  std::vector<Isometry3d> poses_;
  CpuShapePair::Scratch scratch_;
};
}  // namespace

std::optional<JointTable> makeJointTable(const RobotModel& robot, const TableInstance& a, const TableInstance& b,
                                         const CpuShapePair& pairs, const Stopped& stopped, std::uint64_t most_steps)
{
  return TableMaker(robot, a, b, pairs, stopped, most_steps).make();
}
}  // namespace gpu_planning_scene::core
