#include "collision/bounds/reach.h"

#include <algorithm>
#include <cmath>

#include "base/math_constants.h"
#include "collision/geometry/median_split.h"
#include "collision/geometry/shape_bounds.h"
#include "model/joint_limits.h"
#include "model/rigid_pose.h"

// Covers each shape with balls, and sweeps the balls through the joints from the link up to the planning frame. After
// each joint, neighbouring balls are merged until kMaxBalls remain. The balls are merged as in a top-down build of a
// sphere tree, by splitting at the median (Ericson, "Real-Time Collision Detection", 2005, chapter 6). The sweep is our
// own method: the usual estimate of a workspace samples the joints, and samples prove nothing.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// A robot that holds a joint at its limit may report a position slightly outside of it.
constexpr double kBeyondLimit = 1e-3;  // radians or metres

// Exceeds the exact checker's slack of 1e-9 m plus the rounding of kinematics in double within a kilometre, 1e-11 m.
constexpr double kReachMargin = 1e-6;  // metres

// Beyond these values the resolution of a double is too coarse for the margin. The region then counts as unbounded, or
// the joint as turning the full circle.
constexpr double kFarthest = 1e6;            // metres
constexpr double kLargestBallAngle = 100.0;  // radians

// Sweeping through a joint takes some dozens of operations. Each has a rounding error of 2^-53 times the coordinates.
constexpr double kReachRounding = 1e-12;  // relative to the distance from the origin plus the radius

// More balls and parts give tighter bounds, but loading a robot takes longer.
constexpr std::size_t kMaxBalls = 48;  // balls in a region
constexpr int kMaxParts = 12;          // parts of a joint's interval, for each ball
constexpr int kMaxPieces = 6;          // pieces along an edge of a shape's bounding box
// The bounds of longer chains are too wide to exclude a pair.
constexpr int kMaxMovingJoints = 16;

Ball rounded(const Vector3d& center, double radius)
{
  return {center, radius + kReachRounding * (center.norm() + radius)};
}

Ball enclosing(const Ball* begin, const Ball* end)
{
  AlignedBox3d centers;
  for (const Ball* ball = begin; ball != end; ++ball)
    centers.extend(ball->center);
  const Vector3d middle = centers.center();
  double radius = 0.0;
  for (const Ball* ball = begin; ball != end; ++ball)
    radius = std::max(radius, (ball->center - middle).norm() + ball->radius);
  return rounded(middle, radius);
}

/// Splits a set of balls at the median of its longest side, recursively, into at most `max_parts` parts. Adds a ball
/// for each part that contains the part's balls.
void cluster(Ball* begin, Ball* end, std::size_t max_parts, std::vector<Ball>& result)
{
  const auto count = static_cast<std::size_t>(end - begin);
  if (count <= max_parts)
  {
    result.insert(result.end(), begin, end);
    return;
  }
  if (max_parts == 1)
  {
    result.push_back(enclosing(begin, end));
    return;
  }
  Ball* const middle = splitAtMedian(begin, end, [](const Ball& ball) -> const Vector3d& { return ball.center; });
  cluster(begin, middle, max_parts / 2, result);
  cluster(middle, end, max_parts - max_parts / 2, result);
}

Region regionOf(std::vector<Ball> balls)
{
  Region region;
  region.balls = clustered(std::move(balls), kMaxBalls);
  region.enclosing = enclosing(region.balls.data(), region.balls.data() + region.balls.size());
  return region;
}

/// Cuts a box into pieces that are roughly cubes, and adds a ball around each piece.
void cover(const AlignedBox3d& box, const Isometry3d& pose, std::vector<Ball>& balls)
{
  const double edge = std::max(box.sizes().minCoeff(), box.sizes().maxCoeff() / kMaxPieces);
  Eigen::Array3i pieces = Eigen::Array3i::Ones();
  for (int i = 0; i < 3 && edge > 0.0; ++i)
    pieces[i] = std::clamp(static_cast<int>(std::ceil(box.sizes()[i] / edge)), 1, kMaxPieces);
  const Vector3d size = box.sizes().array() / pieces.cast<double>();
  for (int x = 0; x < pieces.x(); ++x)
    for (int y = 0; y < pieces.y(); ++y)
      for (int z = 0; z < pieces.z(); ++z)
      {
        const Vector3d center = box.min().array() + (Eigen::Array3d(x, y, z) + 0.5) * size.array();
        const Ball piece = rounded(center, 0.5 * size.norm());
        balls.push_back(rounded(pose * piece.center, piece.radius));
      }
}

/// The number of parts for an interval that moves a ball's centre by up to `travel` in each direction.
int partsFor(double travel, double radius)
{
  return std::clamp(static_cast<int>(std::ceil(travel / std::max(0.5 * radius, 0.02))), 1, kMaxParts);
}

/// Covers a ball that turns about an axis through the origin by the angles from `lower` to `upper`, which are at most
/// kLargestBallAngle in magnitude. The arc of the ball's centre, with radius rho, is cut into parts of half angle h.
/// Each part lies in a ball around the middle of its chord with radius rho sin h if h < pi / 2: at an angle f from the
/// middle of the arc, the squared distance from this point is rho^2 (1 - 2 cos f cos h + cos^2 h). This is largest at
/// the ends of the arc, f = h, where it equals (rho sin h)^2.
void turn(const Ball& ball, const Vector3d& axis, double lower, double upper, std::vector<Ball>& result)
{
  const Vector3d along = axis.dot(ball.center) * axis;
  const Vector3d radial = ball.center - along;
  const double arm = radial.norm();
  const int parts = partsFor(0.5 * (upper - lower) * arm, ball.radius);
  const double half = 0.5 * (upper - lower) / parts;
  if (half >= 0.5 * kPi)
  {
    result.push_back(rounded(along, ball.radius + arm));
    return;
  }
  const Vector3d sideways = axis.cross(radial);
  for (int part = 0; part < parts; ++part)
  {
    const double angle = lower + (2 * part + 1) * half;
    const Vector3d direction = std::cos(angle) * radial + std::sin(angle) * sideways;
    result.push_back(rounded(along + std::cos(half) * direction, ball.radius + std::sin(half) * arm));
  }
}

void slide(const Ball& ball, const Vector3d& axis, double lower, double upper, std::vector<Ball>& result)
{
  const int parts = partsFor(0.5 * (upper - lower), ball.radius);
  const double half = 0.5 * (upper - lower) / parts;
  for (int part = 0; part < parts; ++part)
    result.push_back(rounded(ball.center + (lower + (2 * part + 1) * half) * axis, ball.radius + half));
}

// NaN counts as near.
bool near(const Ball& a, const Ball& b, double distance)
{
  return !((a.center - b.center).norm() > a.radius + b.radius + distance + kReachMargin);
}

bool near(const Ball& ball, const Obstacle& obstacle, double distance)
{
  const double reach = ball.radius + distance + kReachMargin;
  if (const auto* half_space = std::get_if<HalfSpace>(&obstacle))
    return !(half_space->normal.dot(ball.center) - half_space->offset > reach);
  const PlacedBox& box = std::get<PlacedBox>(obstacle);
  const Vector3d from_box = ball.center - box.pose.translation();
  const double farthest = reach + box.radius + box.rounding;
  if (from_box.squaredNorm() > farthest * farthest)
    return false;
  const Vector3d center = box.pose.linear().transpose() * from_box;
  return !((center.cwiseAbs() - box.half).cwiseMax(0.0).norm() > reach + box.rounding);
}

/// Whether the coordinates of a region are small enough for the margins. False if one of them is NaN.
bool isBound(const Region& region)
{
  return region.enclosing.center.norm() + region.enclosing.radius <= kFarthest;
}
}  // namespace

std::vector<Ball> clustered(std::vector<Ball> balls, std::size_t most)
{
  std::vector<Ball> result;
  cluster(balls.data(), balls.data() + balls.size(), most, result);
  return result;
}

PlacedBox::PlacedBox(const Isometry3d& pose_of_center, const Vector3d& half_lengths)
  : pose(pose_of_center),
    half(half_lengths),
    radius(half_lengths.norm()),
    rounding(kReachRounding * (pose_of_center.translation().norm() + radius))
{
}

std::vector<VariableRange> limitRanges(const RobotModel& robot)
{
  std::vector<VariableRange> ranges;
  for (const Link& link : robot.links())
  {
    if (link.parent_joint < 0)
      continue;
    const Joint& joint = robot.joints()[static_cast<std::size_t>(link.parent_joint)];
    if (joint.type != JointType::Revolute && joint.type != JointType::Prismatic)
      continue;
    const Variable& variable = robot.variables()[static_cast<std::size_t>(joint.first_variable)];
    if (variable.bounded)
      ranges.push_back({joint.first_variable, variable.lower - kBeyondLimit, variable.upper + kBeyondLimit});
  }
  return ranges;
}

std::vector<VariableRange> provenRanges(const RobotModel& robot)
{
  std::vector<VariableRange> ranges = limitRanges(robot);
  for (const Joint& joint : robot.joints())
  {
    if (joint.type == JointType::Planar || joint.type == JointType::Floating)
      for (int variable = joint.first_variable; variable < joint.first_variable + variableCount(joint.type); ++variable)
        if (const Variable& base = robot.variables()[static_cast<std::size_t>(variable)]; base.bounded)
          ranges.push_back({variable, base.lower - kBeyondLimit, base.upper + kBeyondLimit});
    const bool turns = joint.type == JointType::Revolute || joint.type == JointType::Continuous;
    const int angle = turns ? joint.first_variable : joint.type == JointType::Planar ? joint.first_variable + 2 : -1;
    if (angle < 0 || joint.multiplier == 0.0)
      continue;
    const double a = (-kLargestProvenAngle - joint.offset) / joint.multiplier;
    const double b = (kLargestProvenAngle - joint.offset) / joint.multiplier;
    ranges.push_back({angle, std::min(a, b), std::max(a, b)});
  }
  return ranges;
}

Reach::Reach(const RobotModel& robot) : ranges_(limitRanges(robot))
{
  for (const Variable& variable : robot.variables())
    intervals_.push_back(
        variable.bounded ? std::make_optional(Interval{variable.lower - kBeyondLimit, variable.upper + kBeyondLimit})
                         : std::nullopt);
  for (const Link& link : robot.links())
  {
    const Joint joint = link.parent_joint < 0 ? Joint() : robot.joints()[static_cast<std::size_t>(link.parent_joint)];
    depths_.push_back(depth(joint.parent_link) + 1);
    parent_joints_.push_back(joint);
  }
}

int Reach::parent(int link) const
{
  return parent_joints_[static_cast<std::size_t>(link)].parent_link;
}

/// A continuous joint turns the full circle, whatever limits it has. A mimic joint follows the limits of the joint that
/// it mimics. Rounding of pi leaves no gap in a full circle, because the balls are enlarged by more than that.
std::optional<Reach::Interval> Reach::positions(const Joint& joint) const
{
  const Interval circle = {-kPi, kPi};
  const bool turns = joint.type != JointType::Prismatic;
  if (joint.type == JointType::Continuous)
    return circle;
  const std::optional<Interval>& variable = intervals_[static_cast<std::size_t>(joint.first_variable)];
  if (!variable)
    return turns ? std::make_optional(circle) : std::nullopt;
  const double ends[2] = {joint.multiplier * variable->lower + joint.offset,
                          joint.multiplier * variable->upper + joint.offset};
  const double largest = turns ? kLargestBallAngle : kFarthest;
  if (!(std::abs(ends[0]) <= largest && std::abs(ends[1]) <= largest))
    return turns ? std::make_optional(circle) : std::nullopt;
  const Interval interval = {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
  return turns && interval.upper - interval.lower >= 2.0 * kPi ? circle : interval;
}

/// The swept region in the frame of the joint's parent link; `region` is in the frame of its child link. Empty if the
/// region is unbounded.
std::optional<Region> Reach::swept(const Region& region, const Joint& joint) const
{
  if (joint.type == JointType::Planar || joint.type == JointType::Floating)
    return std::nullopt;
  std::vector<Ball> balls;
  if (joint.type == JointType::Fixed)
    balls = region.balls;
  else
  {
    const std::optional<Interval> interval = positions(joint);
    if (!interval)
      return std::nullopt;
    const auto move = joint.type == JointType::Prismatic ? slide : turn;
    for (const Ball& ball : region.balls)
      move(ball, joint.axis, interval->lower, interval->upper, balls);
  }
  for (Ball& ball : balls)
    ball = rounded(joint.origin * ball.center, ball.radius);
  return regionOf(std::move(balls));
}

SweptBody Reach::sweep(const std::vector<PlacedShape>& shapes, const Isometry3d& pose, int link) const
{
  std::vector<Ball> balls;
  for (const PlacedShape& placed : shapes)
    cover(boundsOf(placed.shape), rigidProduct(pose, placed.pose), balls);
  SweptBody body{link, {regionOf(std::move(balls))}};
  if (!isBound(body.region_by_level.front()))
    body.region_by_level.clear();
  int moving_joints = 0;
  for (int at = link; at >= 0 && !body.region_by_level.empty(); at = parent(at))
  {
    const Joint& joint = parent_joints_[static_cast<std::size_t>(at)];
    moving_joints += joint.type == JointType::Fixed ? 0 : 1;
    std::optional<Region> above =
        moving_joints > kMaxMovingJoints ? std::nullopt : swept(body.region_by_level.back(), joint);
    if (!above || !isBound(*above))
      break;
    body.region_by_level.push_back(std::move(*above));
  }
  return body;
}

const Region* Reach::inPlanningFrame(const SweptBody& body) const
{
  const auto above = static_cast<std::size_t>(depth(body.link)) + 1;
  return above < body.region_by_level.size() ? &body.region_by_level[above] : nullptr;
}

/// Compares the regions in the frame of the last link that is above both bodies. Only a mimicked variable can move both
/// bodies relative to this frame. Treating the two motions as independent makes the bounds wider than necessary, but
/// never wrong.
bool Reach::mayMeet(const SweptBody& a, const SweptBody& b, double distance) const
{
  int link_a = a.link;
  int link_b = b.link;
  while (link_a != link_b)
    (depth(link_a) >= depth(link_b) ? link_a : link_b) = parent(depth(link_a) >= depth(link_b) ? link_a : link_b);
  const auto above_a = static_cast<std::size_t>(depth(a.link) - depth(link_a));
  const auto above_b = static_cast<std::size_t>(depth(b.link) - depth(link_b));
  if (above_a >= a.region_by_level.size() || above_b >= b.region_by_level.size())
    return true;
  const Region& region_a = a.region_by_level[above_a];
  const Region& region_b = b.region_by_level[above_b];
  if (!near(region_a.enclosing, region_b.enclosing, distance))
    return false;
  for (const Ball& ball_a : region_a.balls)
    if (near(ball_a, region_b.enclosing, distance))
      for (const Ball& ball_b : region_b.balls)
        if (near(ball_a, ball_b, distance))
          return true;
  return false;
}

bool mayMeet(const Region& region, const Obstacle& obstacle, double distance)
{
  return near(region.enclosing, obstacle, distance) &&
         std::any_of(
             region.balls.begin(), region.balls.end(),
             [&](const Ball& ball) { return near(ball, obstacle, distance); });
}
}  // namespace gpu_planning_scene::core
