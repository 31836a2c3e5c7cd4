#include "node/planning/rehearsal.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <ompl/util/Time.h>

#include "gpu_planning_scene/planning/plan_motion.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kStates = 512;  // as in a round of the batch planner
constexpr double kSeconds = 0.03;

/// Rows whose variables outside the group have the values of `base`.
std::vector<double> randomRows(const RobotModel& robot, const Group& group, const std::vector<double>& base)
{
  const std::size_t width = base.size();
  std::vector<double> rows(kStates * width);
  std::vector<double> random(width);
  std::mt19937_64 generator(1);
  for (auto row = rows.begin(); row != rows.end(); row += static_cast<std::ptrdiff_t>(width))
  {
    robot.randomState(generator, base.data(), random.data());
    std::copy(base.begin(), base.end(), row);
    for (const int variable : group.variables)
      row[variable] = random[static_cast<std::size_t>(variable)];
  }
  return rows;
}
}  // namespace

void rehearsePlans(const std::shared_ptr<const PlanningScene>& scene, const std::shared_ptr<StateChecker>& checker,
                   const std::string& group, const MotionCheckerOptions& motions, const PlannerFactory& factory)
{
  const RobotModel& robot = *scene->robot;
  const std::vector<double> base = scene->current_state.empty() ? robot.defaultState() : scene->current_state;
  const std::vector<double> rows = randomRows(robot, robot.group(group), base);
  const BatchResult result = checker->check(rows.data(), kStates, group);
  // The second check finds the bounds of motions, even if no motion is planned below.
  const JointNeighbourhood unmoved{std::vector<JointTravel>(robot.joints().size()),
                                   std::vector<std::uint32_t>(kStates)};
  checker->check(rows.data(), kStates, group, &unmoved);

  std::vector<std::vector<double>> free;
  for (std::size_t i = 0; i < kStates; ++i)
    if (result.valid[i] != 0)
      free.emplace_back(rows.begin() + static_cast<std::ptrdiff_t>(i * base.size()),
                        rows.begin() + static_cast<std::ptrdiff_t>((i + 1) * base.size()));
  const ompl::time::point begin = ompl::time::now();
  for (std::size_t i = 0; i + 1 < free.size(); i += 2)
  {
    PlanningQuery query;
    query.group = group;
    query.start = free[i];
    query.goals = {free[i + 1]};
    query.seconds = kSeconds - ompl::time::seconds(ompl::time::now() - begin);
    query.simplify = false;
    query.motions = motions;
    if (query.seconds <= 0.0)
      break;
    planMotion(scene, checker, query, factory);
  }
}
}  // namespace gpu_planning_scene::core
