#include "collision/cpu/lanes/lane_frames.h"

#include <algorithm>
#include <cmath>

#include "base/math_constants.h"
#include "collision/cpu/lanes/lane_objects.h"

// The rounding errors of the frames add up from the root to the tips (docs/error_bounds.md, "The lane kernel").
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLargestLaneAngle = 1e4;    // radians: a larger angle modulo 2 pi is not accurate
constexpr double kLargestBaseSlide = 32.0;   // metres, along each direction of a planar or floating joint
constexpr double kLargestCoefficient = 1e6;  // of a quaternion

Matrix3d crossProductMatrix(const Vector3d& a)
{
  Matrix3d matrix;
  matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return matrix;
}

void writeRotation(const Matrix3d& rotation, float* rows)
{
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rows[4 * row + column] = static_cast<float>(rotation(row, column));
}
}  // namespace

LaneFrames::LaneFrames(const RobotModel& robot, const Vector3d& origin, const lanes::Rounding& rounding)
  : rounding_(rounding), limits_(robot.variables().size())
{
  Isometry3d base = Isometry3d::Identity();
  base.translation() = -origin;
  for (std::size_t link = 0; link < robot.links().size(); ++link)
  {
    const int number = robot.links()[link].parent_joint;
    const Joint fixed;
    const Joint& joint = number < 0 ? fixed : robot.joints()[static_cast<std::size_t>(number)];
    const bool has_parent = joint.parent_link >= 0;
    const auto parent = static_cast<std::size_t>(joint.parent_link);
    const Isometry3d pose = (has_parent ? in_frame_[parent] : base) * joint.origin;
    if (joint.type == JointType::Fixed && has_parent)
    {
      frame_of_link_.push_back(frame_of_link_[parent]);
      in_frame_.push_back(pose);
      continue;
    }
    const bool is_first = std::all_of(frames_.begin(), frames_.end(),
                                      [](const lanes::Frame& f) { return f.kind == lanes::FrameKind::Fixed; });
    frame_of_link_.push_back(addFramesOf(robot, joint, has_parent ? frame_of_link_[parent] : -1, pose));
    in_frame_.push_back(Isometry3d::Identity());
    if (is_first && (joint.type == JointType::Planar || joint.type == JointType::Floating))
      base_ = {static_cast<std::uint32_t>(frames_.size()), joint.first_variable, variableCount(joint.type)};
  }
}

/// Adds the frames that a joint moves, and returns the last of them. `origin`: the joint's frame in the parent frame.
int LaneFrames::addFramesOf(const RobotModel& robot, const Joint& joint, int parent, const Isometry3d& origin)
{
  const int v = joint.first_variable;
  const Isometry3d here = Isometry3d::Identity();
  // The position of a base is relative to the point that is nearest to the origin of coordinates.
  const Vector3d nearest =
      parent < 0 ? Vector3d(origin.linear().transpose() * -origin.translation()) : Vector3d::Zero();
  const auto slide_base = [&](const Vector3d& axis, int variable, const Isometry3d& from) {
    parent = addSlide({axis, variable, nearest.dot(axis), kLargestBaseSlide}, parent, from);
  };
  switch (joint.type)
  {
    case JointType::Revolute:
    case JointType::Continuous:
      return addTurn(joint, v, parent, origin);
    case JointType::Prismatic:
    {
      const Variable& limits = robot.variables()[static_cast<std::size_t>(v)];
      const double farthest = std::max(std::abs(limits.lower), std::abs(limits.upper)) + 1e-6;
      return addSlide({joint.axis, v, 0.0, farthest, joint.multiplier, joint.offset}, parent, origin);
    }
    case JointType::Planar:
    {
      const Matrix3d directions = planarDirections(joint.axis);
      slide_base(directions.col(0), v, origin);
      slide_base(directions.col(1), v + 1, here);
      return addTurn(joint, v + 2, parent, here);
    }
    case JointType::Floating:
      slide_base(Vector3d::UnitX(), v, origin);
      slide_base(Vector3d::UnitY(), v + 1, here);
      slide_base(Vector3d::UnitZ(), v + 2, here);
      return addQuaternion(v + 3, parent);
    case JointType::Fixed:
      break;
  }
  lanes::Frame frame{};
  frame.kind = lanes::FrameKind::Fixed;
  writePose(origin, frame.constant);
  return addFrame(frame, parent, origin.translation().norm(), rounding_.constant());
}

/// Adds a frame. `step`: the largest distance of its origin from the parent's; `rotation_error`: of a vector of
/// length 1, by the frame's own rotation.
int LaneFrames::addFrame(lanes::Frame frame, int parent, double step, double rotation_error)
{
  frame.parent = parent;
  const LaneFrameError before = parent < 0 ? LaneFrameError() : errors_[static_cast<std::size_t>(parent)];
  frames_.push_back(frame);
  errors_.push_back(
      {step, before.largest_distance + step, before.rotation_error + rotation_error + rounding_.product(),
       before.position_error + before.rotation_error * step + rounding_.sum() * (before.largest_distance + step)});
  return static_cast<int>(frames_.size()) - 1;
}

/// A frame that turns about the joint's axis.
int LaneFrames::addTurn(const Joint& joint, int variable, int parent, const Isometry3d& origin)
{
  lanes::Frame frame{};
  frame.kind = lanes::FrameKind::Revolute;
  frame.variable = variable;
  frame.multiplier = joint.multiplier;
  frame.offset = joint.offset;
  const Matrix3d rotation = origin.linear();
  const Matrix3d along = joint.axis * joint.axis.transpose();
  writePose(origin, frame.constant);
  writeRotation(rotation * along, frame.constant);
  writeRotation(rotation * (Matrix3d::Identity() - along), frame.first);
  writeRotation(rotation * crossProductMatrix(joint.axis), frame.second);
  limit(variable, {0.0, (kLargestLaneAngle - std::abs(joint.offset)) / std::max(1.0, std::abs(joint.multiplier))});
  return addFrame(frame, parent, origin.translation().norm(), rounding_.turn());
}

/// A frame that slides along an axis. Its position is computed relative to that for the slide's middle.
int LaneFrames::addSlide(const Slide& slide, int parent, const Isometry3d& origin)
{
  const Vector3d axis = origin.linear() * slide.axis;
  Isometry3d middle = origin;
  middle.translation() += (slide.multiplier * slide.middle + slide.offset) * axis;
  lanes::Frame frame{};
  frame.kind = lanes::FrameKind::Prismatic;
  frame.variable = slide.variable;
  frame.multiplier = slide.multiplier;
  frame.offset = -slide.multiplier * slide.middle;
  writePose(middle, frame.constant);
  writePose(Eigen::Isometry3d(Eigen::Translation3d(axis)), frame.first);
  limit(slide.variable, {slide.middle, slide.reach});
  return addFrame(frame, parent, middle.translation().norm() + std::abs(slide.multiplier) * slide.reach,
                  rounding_.constant());
}

/// A frame that turns by a quaternion, whose x is the variable.
int LaneFrames::addQuaternion(int variable, int parent)
{
  lanes::Frame frame{};
  frame.kind = lanes::FrameKind::Turned;
  frame.variable = variable;
  for (int k = 0; k < 4; ++k)
    limit(variable + k, {0.0, kLargestCoefficient});
  return addFrame(frame, parent, 0.0, rounding_.quaternion());
}

/// If several joints share a variable (mimic joints), each of them has the middle 0.
void LaneFrames::limit(int variable, const Limit& limit)
{
  Limit& known = limits_[static_cast<std::size_t>(variable)];
  known = {limit.middle, std::min(known.reach, limit.reach)};
}

double LaneFrames::distanceBetween(int a, int b) const
{
  double distance = 0.0;
  while (a != b)  // parents have smaller numbers
  {
    int& later = a > b ? a : b;
    distance += error(later).step;
    later = frames_[static_cast<std::size_t>(later)].parent;
  }
  return distance;
}

bool LaneFrames::isWithinBounds(const double* state) const
{
  for (std::size_t v = 0; v < limits_.size(); ++v)
    if (!(std::abs(state[v] - limits_[v].middle) <= limits_[v].reach))
      return false;
  return true;
}
}  // namespace gpu_planning_scene::core
