#include "collision/problem/state_validation.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "collision/problem/rows_without.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The number with up to 9 significant digits; very large numbers get an exponent.
std::string text(double value)
{
  std::array<char, 32> digits;
  std::snprintf(digits.data(), digits.size(), "%.9g", value);
  return digits.data();
}
}  // namespace

void requireRobot(const std::shared_ptr<const PlanningScene>& scene)
{
  if (!scene || !scene->robot)
    throw Error("no planning scene was given, or the scene has no robot");
}

void validateNeighbourhood(const RobotModel& robot, const JointNeighbourhood& around, std::size_t count)
{
  const std::size_t joints = robot.joints().size();
  const std::size_t rows = joints == 0 ? 0 : around.travel.size() / joints;
  if (around.rows.size() != count || rows * joints != around.travel.size())
    throw Error("the neighbourhood of " + std::to_string(count) + " states (robot with " + std::to_string(joints) +
                " joints) has " + std::to_string(around.rows.size()) + " row numbers and " +
                std::to_string(around.travel.size()) + " joint travels");
  for (std::size_t i = 0; i < count; ++i)
    if (around.rows[i] >= rows)
      throw Error("the neighbourhood of state " + std::to_string(i) + " names row " + std::to_string(around.rows[i]) +
                  ", but there are " + std::to_string(rows) + " rows");
  if (!around.centers.empty() && around.centers.size() != rows * robot.variables().size())
    throw Error("the neighbourhood has " + std::to_string(around.centers.size()) + " values of centres; " +
                std::to_string(rows) + " rows need " + std::to_string(rows * robot.variables().size()));
  if (!(around.spread >= 0.0 && std::isfinite(around.spread)))
    throw Error("the spread of a neighbourhood is " + std::to_string(around.spread) +
                "; it must be finite and at least 0");
  validateStates(robot, around.centers.data(), around.centers.empty() ? 0 : rows, "centre");
  for (const JointTravel& travel : around.travel)
    if (!(travel.length >= 0.0 && travel.angle >= 0.0 && std::isfinite(travel.length) && std::isfinite(travel.angle)))
      throw Error("the travel of a joint around a state is " + std::to_string(travel.length) + " m and " +
                  std::to_string(travel.angle) + " rad; both must be finite and at least 0");
}

void validateStates(const RobotModel& robot, const double* states, std::size_t count, const char* what)
{
  const auto& variables = robot.variables();
  std::vector<double> largest;
  largest.reserve(variables.size());
  for (const Variable& variable : variables)
    largest.push_back(variable.largest);
  const auto is_allowed = [&](std::size_t row)
  {
    const double* const state = states + row * largest.size();
    bool allowed = true;
    for (std::size_t i = 0; i < largest.size(); ++i)
      allowed = allowed && std::abs(state[i]) <= largest[i];
    return allowed;
  };
  const std::vector<std::size_t> refused = rowsWithout(count, is_allowed);
  if (refused.empty())
    return;
  const double* const state = states + refused.front() * largest.size();
  std::size_t i = 0;
  while (std::abs(state[i]) <= largest[i])
    ++i;
  throw Error(what + (" " + std::to_string(refused.front())) + ": the value of variable '" + variables[i].name +
              "' is " +
              (std::isfinite(state[i]) ? text(state[i]) + "; it must be within " + text(largest[i]) +
                                             ", because no joint can move by more than 1000 km or turn by more than "
                                             "1e300"
                                       : "not a finite number"));
}

ValuesOutsideLimits valuesOutside(const std::vector<VariableRange>& ranges, const RobotModel& robot,
                                  const double* state)
{
  ValuesOutsideLimits outside(robot);
  for (const VariableRange& range : ranges)
    if (const double value = state[range.variable]; value < range.lower || value > range.upper)
      outside.add(range.variable, value);
  return outside;
}
}  // namespace gpu_planning_scene::core
