#include "planning/lines/straight_lines.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/math_constants.h"
#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
double angleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

Eigen::Isometry3d interpolated(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double fraction)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = from.translation() + fraction * (to.translation() - from.translation());
  pose.linear() = Eigen::Quaterniond(from.linear())
                      .slerp(fraction, Eigen::Quaterniond(to.linear()))
                      .normalized()
                      .toRotationMatrix();
  return pose;
}
}  // namespace

StraightLines::StraightLines(const std::vector<Eigen::Isometry3d>& poses, const Lengths& max_step, const Lengths& unit,
                             std::size_t max_poses)
  : unit_(unit)
{
  double at = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i)
  {
    const Eigen::AngleAxisd rotation(poses[i - 1].linear().transpose() * poses[i].linear());
    const double distance = (poses[i].translation() - poses[i - 1].translation()).norm();
    const double count =
        std::max({1.0, std::ceil(distance / max_step.metres), std::ceil(rotation.angle() / max_step.radians)});
    lines_.push_back({poses[i - 1], poses[i], at, at + count, rotation});
    at += count;
  }
  if (!(at < static_cast<double>(max_poses)))
    throw Error("the lines have " + numberText(at) + " steps; they must have less than " + std::to_string(max_poses) +
                ": take larger steps, or fewer waypoints");
  for (std::size_t step = 1; step <= static_cast<std::size_t>(at); ++step)
    steps_.push_back(static_cast<double>(step));
}

const StraightLines::Line& StraightLines::lineAt(double at) const
{
  const auto line = std::find_if(lines_.begin(), lines_.end(), [at](const Line& each) { return at <= each.end; });
  return line == lines_.end() ? lines_.back() : *line;
}

Eigen::Isometry3d StraightLines::pose(double at) const
{
  const Line& line = lineAt(at);
  return interpolated(line.from, line.to, (at - line.begin) / (line.end - line.begin));
}

StraightLines::Lengths StraightLines::deviation(const Eigen::Isometry3d& pose, double begin, double end) const
{
  const Line& line = lineAt(end);
  const auto fraction_of = [&line](double at) { return (at - line.begin) / (line.end - line.begin); };
  // The mean of two fractions: the one with the nearest position and the one with the nearest orientation. Their
  // weights are the squares of the line's lengths in metres and in radians.
  const Eigen::Vector3d direction = line.to.translation() - line.from.translation();
  const double by_position = direction.squaredNorm() / (unit_.metres * unit_.metres);
  const double by_orientation = line.rotation.angle() * line.rotation.angle() / (unit_.radians * unit_.radians);
  double fraction = fraction_of(0.5 * (begin + end));
  if (by_position + by_orientation > 0.0)
  {
    const double metres = (pose.translation() - line.from.translation()).dot(direction);
    const Eigen::Quaterniond turned(line.from.linear().transpose() * pose.linear());
    const double radians = 2.0 * std::atan2(turned.vec().dot(line.rotation.axis()), turned.w());
    const double middle = fraction * line.rotation.angle();
    const double near = middle + std::remainder(radians - middle, 2.0 * kPi);
    fraction =
        (metres / (unit_.metres * unit_.metres) + near * line.rotation.angle() / (unit_.radians * unit_.radians)) /
        (by_position + by_orientation);
  }
  const Eigen::Isometry3d nearest =
      interpolated(line.from, line.to, std::clamp(fraction, fraction_of(begin), fraction_of(end)));
  return {(pose.translation() - nearest.translation()).norm(), angleBetween(pose, nearest)};
}
}  // namespace gpu_planning_scene::core
