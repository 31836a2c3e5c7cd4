#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Core>

#include "base/text/number_text.h"
#include "gpu_planning_scene/interpolation.h"

namespace gpu_planning_scene::core
{
namespace
{
// People write headings with two or three decimals. A base cannot be steered more exactly than this.
constexpr double kAside = 1e-3;  // metres, metres for each metre of the way, and radians

/// The part of the motion that the base cannot drive, in words; empty if it can drive all of it. `from`, `to`: x, y and
/// theta.
std::string sidewaysPart(const double* from, const double* to)
{
  const Eigen::Vector2d way(to[0] - from[0], to[1] - from[1]);
  const Eigen::Vector2d heading(std::cos(from[2]), std::sin(from[2]));
  const double aside = std::abs(heading.x() * way.y() - heading.y() * way.x());
  if (!(aside <= kAside * std::max(1.0, way.norm())))
    return "moves " + numberText(aside) + " m sideways";
  const double turn = std::abs(shortestAngularDistance(from[2], to[2]));
  if (!(way.norm() <= kAside) && !(turn <= kAside))
    return "turns by " + numberText(turn) + " radians while it drives";
  return "";
}
}  // namespace

std::string sidewaysMotion(const RobotModel& robot, const double* starts, const double* ends, std::size_t count,
                           const std::string& what)
{
  const std::size_t width = robot.variables().size();
  for (const Joint& joint : robot.joints())
    for (std::size_t i = 0; joint.diff_drive && i < count; ++i)
    {
      const std::size_t value = i * width + static_cast<std::size_t>(joint.first_variable);
      if (const std::string part = sidewaysPart(starts + value, ends + value); !part.empty())
        return what + " " + std::to_string(i) + ": joint '" + joint.name + "' " + part +
               ", which its motion_model diff_drive (SRDF) cannot do; give its way as turns on the spot and straight " +
               "drives along its heading";
    }
  return "";
}
}  // namespace gpu_planning_scene::core
