#include "planning/timing/blended_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

// Each segment has a largest speed V and a largest acceleration A, from the limits of the variables. The robot reaches
// a waypoint with the fraction r of the V of the segment before, and leaves it with the fraction r of the V of the
// segment after it. In between, the acceleration is constant, which gives a parabola. If it lasts t seconds for r = 1,
// it lasts r t seconds at the same acceleration, and its arms and its deviation are proportional to r^2. A backward and
// a forward pass find the largest r^2 at which the robot can brake and accelerate on the segments.
//
// T. Kunz, M. Stilman: Turning paths into trajectories using parabolic blends (2011). J. J. Craig: Introduction to
// Robotics, section 7.3. There, a segment has one speed; the trapezoidal profiles and the passes are our own.
namespace gpu_planning_scene::core
{
namespace
{
/// Below this time, in seconds, a change of velocity is a rounding error: the path goes straight on.
constexpr double kStraight = 1e-9;

/// The largest number by which `direction` can be multiplied so that no component exceeds its limit.
double largestFactor(const Eigen::ArrayXd& limits, const Eigen::ArrayXd& direction)
{
  return 1.0 / (direction.abs() / limits).maxCoeff();
}
}  // namespace

BlendedPath::BlendedPath(std::vector<Eigen::ArrayXd> waypoints, const Eigen::ArrayXd& max_velocity,
                         const Eigen::ArrayXd& max_acceleration, double max_deviation)
  : waypoints_(std::move(waypoints)), corner_seconds_(waypoints_.size()), largest_sizes_(waypoints_.size())
{
  for (std::size_t i = 0; i + 1 < waypoints_.size(); ++i)
  {
    const Eigen::ArrayXd change = waypoints_[i + 1] - waypoints_[i];
    const double length = change.abs().maxCoeff();
    const Eigen::ArrayXd direction = change / length;
    segments_.push_back(
        {direction, length, largestFactor(max_velocity, direction), largestFactor(max_acceleration, direction)});
  }
  for (std::size_t i = 1; i < segments_.size(); ++i)
  {
    const Segment& before = segments_[i - 1];
    const Segment& after = segments_[i];
    const Eigen::ArrayXd change = after.max_speed * after.direction - before.max_speed * before.direction;
    const double seconds = (change.abs() / max_acceleration).maxCoeff();
    largest_sizes_[i] = 1.0;
    if (seconds < kStraight)
      continue;
    corner_seconds_[i] = seconds;
    // A parabola deviates from its two tangents by an eighth of the change of velocity times its duration. It may take
    // half of each segment.
    largest_sizes_[i] =
        std::min({1.0, 8.0 * max_deviation / (change.abs().maxCoeff() * seconds),
                  before.length / (before.max_speed * seconds), after.length / (after.max_speed * seconds)});
  }
  computeSizes();
}

void BlendedPath::computeSizes()
{
  sizes_ = largest_sizes_;
  // The squares of the speeds at the two ends may differ by at most 2 A (length - arms).
  const auto limit = [this](std::size_t segment, std::size_t from, std::size_t to)
  {
    const auto& [direction, length, speed, acceleration] = segments_[segment];
    const double room = sizes_[from] * speed * speed + 2.0 * acceleration * (length - arm(segments_[segment], from));
    sizes_[to] = std::min(sizes_[to], room / (speed * speed + acceleration * speed * corner_seconds_[to]));
  };
  for (std::size_t i = segments_.size(); i-- > 0;)
    limit(i, i + 1, i);
  for (std::size_t i = 0; i < segments_.size(); ++i)
    limit(i, i, i + 1);
}

Phase BlendedPath::blend(std::size_t waypoint) const
{
  const Segment& before = segments_[waypoint - 1];
  const Segment& after = segments_[waypoint];
  const double fraction = std::sqrt(sizes_[waypoint]);
  const Eigen::ArrayXd change = after.max_speed * after.direction - before.max_speed * before.direction;
  return {waypoints_[waypoint] - arm(before, waypoint) * before.direction,
          fraction * before.max_speed * before.direction, change / corner_seconds_[waypoint],
          fraction * corner_seconds_[waypoint]};
}

/// Adds the phases of a segment between its parabolas: it accelerates, keeps its speed, and brakes.
void BlendedPath::addSegment(std::size_t segment, std::vector<Phase>& phases) const
{
  const auto& [direction, length, max_speed, acceleration] = segments_[segment];
  const double first = max_speed * std::sqrt(sizes_[segment]);
  const double last = max_speed * std::sqrt(sizes_[segment + 1]);
  double travelled = arm(segments_[segment], segment);
  const double distance = std::max(0.0, length - travelled - arm(segments_[segment], segment + 1));
  const double peak = std::max(
      {first, last, std::min(max_speed, std::sqrt(0.5 * (first * first + last * last) + acceleration * distance))});
  const auto add = [&, &direction = direction](double speed, double change, double seconds)
  {
    if (!(seconds > 0.0))
      return;
    phases.push_back({waypoints_[segment] + travelled * direction, speed * direction, change * direction, seconds});
    travelled += seconds * (speed + 0.5 * seconds * change);
  };
  const double speeding_up = (peak - first) / acceleration;
  const double braking = (peak - last) / acceleration;
  add(first, acceleration, speeding_up);
  add(peak, 0.0, (distance - 0.5 * (speeding_up * (first + peak) + braking * (peak + last))) / peak);
  add(peak, -acceleration, braking);
}

std::vector<Phase> BlendedPath::phases() const
{
  std::vector<Phase> phases;
  for (std::size_t i = 0; i < segments_.size(); ++i)
  {
    addSegment(i, phases);
    if (hasBlend(i + 1))
      phases.push_back(blend(i + 1));
  }
  return phases;
}
}  // namespace gpu_planning_scene::core
