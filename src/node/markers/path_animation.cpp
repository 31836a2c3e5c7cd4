#include "node/markers/path_animation.h"

#include <algorithm>
#include <cmath>

#include "gpu_planning_scene/interpolation.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kLengthUnit = 1e-4;  // radians and metres: resolution of the lengths of motions
}  // namespace

AnimatedPath pathAtConstantSpeed(const RobotModel& robot, const std::vector<std::vector<double>>& waypoints)
{
  AnimatedPath path{waypoints, {}};
  double length = 0.0;
  for (std::size_t i = 0; i < waypoints.size(); ++i)
  {
    if (i > 0)
      length += segmentCount(robot, waypoints[i - 1].data(), waypoints[i].data(), {kLengthUnit, kLengthUnit});
    path.seconds.push_back(length);
  }
  for (double& seconds : path.seconds)
    seconds *= length > 0.0 ? kAnimationSeconds / length : 0.0;
  return path;
}

AnimatedPath pathAtItsTimes(const TimedPath& timed)
{
  AnimatedPath path;
  for (const TimedPoint& point : timed.points)
  {
    path.states.push_back(point.positions);
    path.seconds.push_back(point.seconds);
  }
  return path;
}

std::vector<double> animatedState(const RobotModel& robot, const AnimatedPath& path, double seconds)
{
  const double duration = path.seconds.back();
  const double now = std::fmod(std::max(0.0, seconds), duration + kAnimationPause);
  if (now >= duration)
    return path.states.back();
  const auto next =
      static_cast<std::size_t>(std::upper_bound(path.seconds.begin(), path.seconds.end(), now) - path.seconds.begin());
  const double begin = path.seconds[next - 1];
  const double fraction = (now - begin) / (path.seconds[next] - begin);
  std::vector<double> state = path.states[next - 1];
  interpolate(robot, path.states[next - 1].data(), path.states[next].data(), fraction, state.data());
  return state;
}
}  // namespace gpu_planning_scene::core
