#include "planning/straight_lines.h"

#include <algorithm>
#include <cmath>

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

StraightLines::StraightLines(const std::vector<Eigen::Isometry3d>& poses, double max_step, double max_rotation_step)
{
  double at = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i)
  {
    const double distance = (poses[i].translation() - poses[i - 1].translation()).norm();
    const double count = std::max(
        {1.0, std::ceil(distance / max_step), std::ceil(angleBetween(poses[i - 1], poses[i]) / max_rotation_step)});
    lines_.push_back({poses[i - 1], poses[i], at, at + count});
    for (std::size_t step = 1; step <= static_cast<std::size_t>(count); ++step)
      steps_.push_back(at + static_cast<double>(step));
    at += count;
  }
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

StraightLines::Deviation StraightLines::deviation(const Eigen::Isometry3d& pose, double begin, double end) const
{
  const Line& line = lineAt(end);
  const auto fraction_of = [&line](double at) { return (at - line.begin) / (line.end - line.begin); };
  const Eigen::Vector3d direction = line.to.translation() - line.from.translation();
  const double length = direction.squaredNorm();
  double fraction = fraction_of(0.5 * (begin + end));
  if (length > 0.0)
    fraction = (pose.translation() - line.from.translation()).dot(direction) / length;
  const Eigen::Isometry3d nearest =
      interpolated(line.from, line.to, std::clamp(fraction, fraction_of(begin), fraction_of(end)));
  const double distance = (pose.translation() - nearest.translation()).norm();
  if (length > 0.0)
    return {distance, angleBetween(pose, nearest)};
  // A line without length: the orientation of least difference within the step.
  const double whole = angleBetween(interpolated(line.from, line.to, fraction_of(begin)),
                                    interpolated(line.from, line.to, fraction_of(end)));
  return {distance, std::max(0.0, angleBetween(pose, nearest) - 0.5 * whole)};
}
}  // namespace gpu_planning_scene::core
