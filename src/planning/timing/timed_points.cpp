#include "planning/timing/timed_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// Cubic interpolation of the positions and velocities at the ends of a phase equals the phase, because its acceleration
// is constant. Quintic interpolation, which also uses the accelerations, differs from it where the acceleration jumps:
// by less than 0.018 times the jump and the square of the time between the two points. So a point just before the jump
// has the old acceleration. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr double kBeforeJump = 1e-3;  // seconds
// Seconds; messages round times to nanoseconds, which must stay small against the distance of two points.
constexpr double kLeastSpacing = 1e-5;
// Seconds: points are at most 0.1 s apart, also where one is left out. Some readers interpolate linearly.
constexpr double kSpacing = 0.1 - kLeastSpacing;

std::vector<double> rowOf(const Eigen::ArrayXd& values)
{
  return {values.data(), values.data() + values.size()};
}

class Points
{
 public:
  void add(const Phase& phase, bool jumps)
  {
    const double count = std::ceil(phase.seconds / kSpacing);
    // If the point before is too near, the acceleration of the phase begins there, less than 1e-5 s too early.
    if (!points_.empty() && begin_ - points_.back().seconds < kLeastSpacing)
      points_.back().accelerations = rowOf(phase.acceleration);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      add(phase, static_cast<double>(k) * phase.seconds / count);
    if (jumps)
      add(phase, phase.seconds - std::min(kBeforeJump, 0.5 * phase.seconds));
    begin_ += phase.seconds;
  }

  /// Adds the last point, and returns all.
  std::vector<TimedPoint> finish(const std::vector<double>& goal)
  {
    while (points_.size() > 1 && begin_ - points_.back().seconds < kLeastSpacing)
      points_.pop_back();
    const std::vector<double> rest(goal.size(), 0.0);
    points_.push_back(
        {points_.empty() ? 0.0 : std::max(begin_, points_.back().seconds + kLeastSpacing), goal, rest, rest});
    return std::move(points_);
  }

 private:
  void add(const Phase& phase, double time)
  {
    if (points_.empty() || begin_ + time - points_.back().seconds >= kLeastSpacing)
      points_.push_back(
          {begin_ + time, rowOf(phase.positionAt(time)), rowOf(phase.velocityAt(time)), rowOf(phase.acceleration)});
  }

  std::vector<TimedPoint> points_;
  double begin_ = 0.0;  // of the phase
};
}  // namespace

std::vector<TimedPoint> timedPoints(const std::vector<Phase>& phases, const std::vector<double>& goal)
{
  Points points;
  for (std::size_t i = 0; i < phases.size(); ++i)
    points.add(phases[i], i + 1 == phases.size() || (phases[i].acceleration != phases[i + 1].acceleration).any());
  return points.finish(goal);
}
}  // namespace gpu_planning_scene::core
