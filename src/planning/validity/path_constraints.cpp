#include "gpu_planning_scene/planning/path_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/math_constants.h"
#include "gpu_planning_scene/interpolation.h"
#include "model/inverse_kinematics/constraint_values.h"
#include "model/inverse_kinematics/kinematic_chains.h"

// A sample in the middle of a segment proves the segment if its slack exceeds the largest change to the ends of the
// segment. If not, the segment is halved. The same idea as for collisions: F. Schwarzer, M. Saha, J.-C. Latombe: Exact
// collision checking of robot paths (2002).
namespace gpu_planning_scene::core
{
namespace
{
// Limits of a motion: a motion that needs more is close to the ends of its tolerances.
constexpr int kMostSamples = 2000;

/// Largest displacements from the middle of a segment to its ends.
struct Displacement
{
  double point = 0.0;     ///< metres
  double rotation = 0.0;  ///< radians, of the link
};

/// `travel`: of each joint from the middle to an end. `poses`: in the middle. The distance of a point from a joint
/// changes by the displacements that the joints between them cause, so these are summed from the link to the root.
Displacement displacementOf(const RobotModel& robot, int link, const Eigen::Vector3d& point,
                            const std::vector<JointTravel>& travel, double share, const Eigen::Isometry3d* poses)
{
  Displacement displacement;
  for (int at = link; at >= 0;)
  {
    const int joint = robot.links()[static_cast<std::size_t>(at)].parent_joint;
    if (joint < 0)
      break;
    const JointTravel& by = travel[static_cast<std::size_t>(joint)];
    const double distance = (point - poses[at].translation()).norm() + displacement.point;
    displacement.point += share * (by.angle * distance + by.length);
    displacement.rotation += share * by.angle;
    at = robot.joints()[static_cast<std::size_t>(joint)].parent_link;
  }
  return displacement;
}

enum class Verdict
{
  Violated,
  Open,
  Proven
};

Verdict verdictOf(double value, double change, double tolerance)
{
  if (value > tolerance)
    return Verdict::Violated;
  return value + change <= tolerance ? Verdict::Proven : Verdict::Open;
}

/// The largest rates of the three numbers of a constraint, per radian, while the link turns by at most `rotation`.
Eigen::Vector3d largestRates(const OrientationConstraint& constraint, const Eigen::Vector3d& angles, double rotation)
{
  if (constraint.parameterization == OrientationConstraint::Parameterization::RotationVector)
    return Eigen::Vector3d::Constant(0.5 * kPi);  // at half a turn; 1 at small angles
  const double b = std::abs(angles.y()) + rotation;
  const double rate = b < 0.5 * kPi ? 1.0 / std::cos(b) : std::numeric_limits<double>::infinity();
  return {rate, 1.0, rate};
}

/// The check of one motion.
class Motion
{
 public:
  Motion(const RobotModel& robot, const InverseKinematics& kinematics, const double* from, const double* to)
    : robot_(robot),
      kinematics_(kinematics),
      from_(from),
      to_(to),
      travel_(jointTravel(robot, from, to)),
      state_(robot.variables().size())
  {
  }

  /// Depth first: the first violated sample ends the check.
  bool isProven(double begin, double end)
  {
    if (++samples_ > kMostSamples)
      return false;
    const Verdict verdict = check(0.5 * (begin + end), 0.5 * (end - begin));
    if (verdict != Verdict::Open)
      return verdict == Verdict::Proven;
    const double middle = 0.5 * (begin + end);
    return middle > begin && middle < end && isProven(begin, middle) && isProven(middle, end);
  }

 private:
  Verdict check(double fraction, double half)
  {
    interpolate(robot_, from_, to_, fraction, state_.data());
    kinematics_.chains().computePoses(state_.data(), workspace_);
    Verdict worst = Verdict::Proven;
    for (const PositionConstraint& constraint : kinematics_.constraints().positions)
      worst = std::min(worst, check(constraint, half));
    for (const OrientationConstraint& constraint : kinematics_.constraints().orientations)
      worst = std::min(worst, check(constraint, half));
    return worst;
  }

  Verdict check(const PositionConstraint& constraint, double half) const
  {
    const Eigen::Isometry3d& link = workspace_.poses[static_cast<std::size_t>(constraint.link)];
    const Eigen::Vector3d local = localPoint(constraint, link);
    const double change =
        displacementOf(robot_, constraint.link, link * constraint.point, travel_, half, workspace_.poses.data()).point;
    if (const auto* sphere = std::get_if<Sphere>(&constraint.region))
      return verdictOf(local.norm(), change, sphere->radius);
    const Eigen::Vector3d size = std::get<Box>(constraint.region).size;
    Verdict worst = Verdict::Proven;
    for (int axis = 0; axis < 3; ++axis)
      worst = std::min(worst, verdictOf(std::abs(local[axis]), change, 0.5 * size[axis]));
    return worst;
  }

  Verdict check(const OrientationConstraint& constraint, double half) const
  {
    const Eigen::Isometry3d& link = workspace_.poses[static_cast<std::size_t>(constraint.link)];
    const Eigen::Vector3d angles = orientationValues(constraint, link).angles;
    const double rotation =
        displacementOf(robot_, constraint.link, link.translation(), travel_, half, workspace_.poses.data()).rotation;
    const Eigen::Vector3d rates = largestRates(constraint, angles, rotation);
    Verdict worst = Verdict::Proven;
    for (int axis = 0; axis < 3; ++axis)
      if (constraint.tolerance[axis] < kPi)
        worst = std::min(worst, verdictOf(std::abs(angles[axis]), rates[axis] * rotation, constraint.tolerance[axis]));
    return worst;
  }

  const RobotModel& robot_;
  const InverseKinematics& kinematics_;
  const double* const from_;
  const double* const to_;
  const std::vector<JointTravel> travel_;
  std::vector<double> state_;
  KinematicChains::Workspace workspace_;
  int samples_ = 0;
};

/// Whether a motion whose ends are within a range stays within it. Joints move monotonically, so the ends decide,
/// except for an angle whose whole turns do not matter: between its ends, it can take the arc outside the range.
bool turnsWithin(const RobotModel& robot, const JointConstraint& range, const double* from, const double* to)
{
  constexpr double kTurn = 2.0 * kPi;
  if (!range.is_turn || range.upper - range.lower >= kTurn)
    return true;
  const double first = from[range.variable];
  const double last = to[range.variable];
  const bool is_wrapped = std::all_of(robot.joints().begin(), robot.joints().end(),
                                      [&](const Joint& joint) {
                                        return joint.type != JointType::Continuous ||
                                               joint.first_variable != range.variable || isPeriodic(robot, joint);
                                      });
  const double travel = is_wrapped ? shortestAngularDistance(first, last) : last - first;
  const double middle = 0.5 * (range.lower + range.upper);
  // Without the arc outside the range, these angles from the middle do not wrap.
  return std::abs(std::remainder(first - middle, kTurn) + travel - std::remainder(last - middle, kTurn)) < kPi;
}
}  // namespace

bool PathConstraints::holdAlong(const double* from, const double* to) const
{
  const std::vector<JointConstraint>& ranges = constraints().joints;
  return violation(from).joint == 0.0 && violation(to).joint == 0.0 &&
         std::all_of(ranges.begin(), ranges.end(),
                     [&](const JointConstraint& range) { return turnsWithin(*robot_, range, from, to); }) &&
         Motion(*robot_, kinematics_, from, to).isProven(0.0, 1.0);
}
}  // namespace gpu_planning_scene::core
