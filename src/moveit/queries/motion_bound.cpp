#include "moveit/queries/motion_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <moveit/robot_model/planar_joint_model.h>
#include <moveit/robot_model/revolute_joint_model.h>

// For each joint between a link and the root: the joint's travel times the largest distance that a point of the link
// can have from the joint's axis (Schwarzer, Saha, Latombe 2002, "Exact collision checking of robot paths"). This
// distance is at most the length of the chain between the joint and the point, whatever the joints in between do.
namespace gpu_planning_scene::detector
{
namespace
{
using moveit::core::JointModel;
using moveit::core::LinkModel;
using moveit::core::RobotState;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// The travel of a joint between two states, and the largest translation between its two links that the joint makes.
struct Travel
{
  double angle = 0.0;   // radians
  double length = 0.0;  // metres
  double offset = 0.0;  // metres
};

/// The angle by which MoveIt turns a joint that has no limits: see RevoluteJointModel::interpolate. Values beyond a
/// turn are not reduced, so this differs from JointModel::distance.
double turnBetween(double a, double b)
{
  const double difference = std::abs(b - a);
  return difference <= M_PI ? difference : std::abs(2.0 * M_PI - difference);
}

bool isContinuous(const JointModel& joint)
{
  return joint.getType() == JointModel::REVOLUTE &&
         static_cast<const moveit::core::RevoluteJointModel&>(joint).isContinuous();
}

Travel planarTravel(const moveit::core::PlanarJointModel& joint, const double* a, const double* b)
{
  Travel travel;
  travel.length = std::hypot(b[0] - a[0], b[1] - a[1]);
  travel.angle = turnBetween(a[2], b[2]);
  travel.offset = std::max(std::hypot(a[0], a[1]), std::hypot(b[0], b[1]));
  if (joint.getMotionModel() != moveit::core::PlanarJointModel::HOLONOMIC)
    travel.angle = travel.length = kUnbounded;
  return travel;
}

/// MoveIt adds the given quaternions with weights, and normalises the sum. The weights come from the product of the
/// quaternions as given. So the joint turns by the angle of the normalised quaternions, at a speed that varies by less
/// than kSpeedError: the product is wrong by at most 4 kTolerance.
Travel floatingTravel(const double* a, const double* b)
{
  const Eigen::Map<const Eigen::Vector3d> position_a(a);
  const Eigen::Map<const Eigen::Vector3d> position_b(b);
  const Eigen::Map<const Eigen::Vector4d> rotation_a(a + 3);
  const Eigen::Map<const Eigen::Vector4d> rotation_b(b + 3);
  constexpr double kTolerance = 1e-6;  // of a norm
  constexpr double kSpeedError = 1e-4;
  Travel travel;
  travel.length = (position_b - position_a).norm();
  travel.offset = std::max(position_a.norm(), position_b.norm());
  const bool are_normalised =
      std::abs(rotation_a.norm() - 1.0) <= kTolerance && std::abs(rotation_b.norm() - 1.0) <= kTolerance;
  const Eigen::Vector4d unit_a = rotation_a.normalized();
  const Eigen::Vector4d unit_b = rotation_b.normalized();
  const double angle = 4.0 * std::atan2((unit_a - unit_b).norm(), (unit_a + unit_b).norm());
  travel.angle = are_normalised && rotation_a.dot(rotation_b) >= 0.0 ? (1.0 + kSpeedError) * angle : kUnbounded;
  return travel;
}

Travel travelOf(const JointModel& joint, const RobotState& from, const RobotState& to)
{
  Travel travel;
  if (joint.getType() == JointModel::FIXED)
    return travel;
  if (const JointModel* leader = joint.getMimic())
  {
    const Travel of_leader = travelOf(*leader, from, to);
    // A leader that passes half a turn jumps by a whole one, and its followers jump with it.
    const bool jumps =
        isContinuous(*leader) && !(std::abs(*to.getJointPositions(leader) - *from.getJointPositions(leader)) <= M_PI);
    const double motion = jumps ? kUnbounded : std::abs(joint.getMimicFactor()) * (of_leader.angle + of_leader.length);
    switch (joint.getType())
    {
      case JointModel::REVOLUTE:
        travel.angle = motion;
        return travel;
      case JointModel::PRISMATIC:
        travel.length = motion;
        travel.offset = std::abs(joint.getMimicFactor()) * std::max(std::abs(*from.getJointPositions(leader)),
                                                                    std::abs(*to.getJointPositions(leader))) +
                        std::abs(joint.getMimicOffset());
        return travel;
      default:  // of several variables, MoveIt sets only the first one
        travel.angle = travel.length = kUnbounded;
        return travel;
    }
  }
  const double* a = from.getJointPositions(&joint);
  const double* b = to.getJointPositions(&joint);
  switch (joint.getType())
  {
    case JointModel::REVOLUTE:
      travel.angle = isContinuous(joint) ? turnBetween(*a, *b) : std::abs(*b - *a);
      return travel;
    case JointModel::PRISMATIC:
      travel.length = joint.distance(a, b);
      travel.offset = std::max(std::abs(*a), std::abs(*b));
      return travel;
    case JointModel::PLANAR:
      return planarTravel(static_cast<const moveit::core::PlanarJointModel&>(joint), a, b);
    case JointModel::FLOATING:
      return floatingTravel(a, b);
    default:
      travel.angle = travel.length = kUnbounded;
      return travel;
  }
}

/// The largest distance of the points of a shape instance from the origin of its link. Poses of any one state give it,
/// because the shape is fixed to its link.
double radiusOf(const ShapeInstance& instance, const RobotState& state)
{
  if (instance.shape->kind() != ShapeKind::Solid)
    return kUnbounded;
  const core::CpuTree& tree = instance.shape->tree();
  const Eigen::Vector3d origin = state.getGlobalLinkTransform(instance.body.link).translation();
  return (*instance.pose * tree.center - origin).norm() + tree.half.norm();
}
}  // namespace

std::vector<double> displacementBounds(const RobotState& from, const RobotState& to, const RobotState& placed,
                                       const std::vector<ShapeInstance>& instances)
{
  std::map<const JointModel*, Travel> travels;
  for (const JointModel* joint : from.getRobotModel()->getJointModels())
    travels[joint] = travelOf(*joint, from, to);
  std::vector<double> bounds;
  for (const ShapeInstance& instance : instances)
  {
    double reach = radiusOf(instance, placed);
    double bound = 0.0;
    for (const LinkModel* link = instance.body.link; link; link = link->getParentLinkModel())
    {
      const Travel& travel = travels[link->getParentJointModel()];
      bound += travel.length;
      if (travel.angle != 0.0)
        bound += travel.angle * reach;
      reach += link->getJointOriginTransform().translation().norm() + travel.offset;
    }
    bounds.push_back(bound);
  }
  return bounds;
}
}  // namespace gpu_planning_scene::detector
