#include "planning/goals/checked_endpoints.h"

#include "base/text/number_text.h"
#include "collision/bounds/reach.h"
#include "collision/problem/state_validation.h"
#include "model/joint_limits.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

/// A fault of the start or of a goal. An empty message means no fault.
struct Fault
{
  PlanningStatus status = PlanningStatus::Solved;
  std::string message;
};

Fault outOfBounds(const RobotModel& robot, const GroupStateSpace& space, const PlanningQuery& query, const double* row)
{
  ValuesOutsideLimits outside(robot);
  for (std::size_t i = 0; i < space.variables().size(); ++i)
  {
    const int index = space.variables()[i];
    const Variable& variable = robot.variables()[static_cast<std::size_t>(index)];
    const auto [lower, upper] = space.ranges()[i];
    if (row[index] >= lower && row[index] <= upper)
      continue;
    if (query.workspace && !(variable.bounded && (row[index] < variable.lower || row[index] > variable.upper)))
      return {PlanningStatus::OutOfBounds, "out of bounds: joint '" + variable.name + "' is " + numberText(row[index]) +
                                               ", outside the workspace of the request, " + numberText(lower) + " to " +
                                               numberText(upper)};
    outside.add(index, row[index]);
  }
  if (outside.count() == 0)
    return {};
  return {PlanningStatus::OutOfBounds, "out of bounds: " + outside.text()};
}

/// A joint beyond its limits makes every proof of a motion impossible, even if the group does not move this joint.
Fault outsideOfProof(const RobotModel& robot, const double* row)
{
  const ValuesOutsideLimits outside = valuesOutside(provenRanges(robot), robot, row);
  if (outside.count() == 0)
    return {};
  return {PlanningStatus::OutOfBounds,
          "out of bounds: " + outside.text() + "; the motion rule \"bound\" proves no motion there"};
}

Fault outsideOfConstraints(const PathConstraints& constraints, const double* row, bool is_start)
{
  const ConstraintViolation violation = constraints.violation(row);
  if (violation.isNone())
    return {};
  return {is_start ? PlanningStatus::StartViolatesConstraints : PlanningStatus::GoalViolatesConstraints,
          "outside the path constraints: " + violation.text()};
}

/// The row of the start, then the rows of the goals. Variables outside the group have the values of the start.
std::vector<double> rowsOf(const PlanningQuery& query, const GroupStateSpace& space)
{
  std::vector<double> rows = query.start;
  for (const std::vector<double>& goal : query.goals)
  {
    rows.insert(rows.end(), query.start.begin(), query.start.end());
    for (const int variable : space.variables())
      rows[rows.size() - query.start.size() + static_cast<std::size_t>(variable)] =
          goal[static_cast<std::size_t>(variable)];
  }
  return rows;
}

std::vector<Fault> faultsOf(const PlanningScene& scene, StateChecker& checker, const GroupStateSpace& space,
                            const PlanningQuery& query, const std::vector<double>& rows,
                            const PathConstraints* constraints)
{
  const std::size_t width = query.start.size();
  const std::size_t count = query.goals.size() + 1;
  const BatchResult found = checker.check(rows.data(), count, query.group);
  std::vector<Fault> faults(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const double* const row = rows.data() + i * width;
    Fault& fault = faults[i];
    if (i == 0 && query.motions.rule == MotionRule::Bound)
      fault = outsideOfProof(*scene.robot, row);
    if (fault.message.empty())
      fault = outOfBounds(*scene.robot, space, query, row);
    if (fault.message.empty() && found.valid[i] == 0)
      fault = {
          i == 0 ? PlanningStatus::StartInCollision : PlanningStatus::GoalInCollision,
          "in collision: " + scene.bodyName(found.colliding[i][0]) + " and " + scene.bodyName(found.colliding[i][1])};
    if (fault.message.empty() && constraints)
      fault = outsideOfConstraints(*constraints, row, i == 0);
  }
  return faults;
}
}  // namespace

CheckedEndpoints checkEndpoints(const PlanningScene& scene, StateChecker& checker, const ob::StateSpacePtr& space,
                                const PlanningQuery& query, const PathConstraints* constraints)
{
  const auto& group_space = *space->as<GroupStateSpace>();
  const std::vector<double> rows = rowsOf(query, group_space);
  const std::vector<Fault> faults = faultsOf(scene, checker, group_space, query, rows, constraints);
  CheckedEndpoints endpoints;
  if (!faults.front().message.empty())
    return {faults.front().status, "the start is " + faults.front().message, {}};
  for (std::size_t i = 1; i < faults.size(); ++i)
    if (faults[i].message.empty())
    {
      endpoints.goals.emplace_back(space);
      group_space.copyFromRow(rows.data() + i * query.start.size(), endpoints.goals.back().get());
    }
  if (!endpoints.goals.empty() || query.goals.empty())
    return endpoints;
  if (!query.goal_regions.empty())
  {
    endpoints.fault_beside_regions =
        (query.goals.size() == 1 ? "the goal state is " : "goal state 0 is ") + faults[1].message;
    return endpoints;
  }
  endpoints.status = faults[1].status;
  endpoints.message = (query.goals.size() == 1 ? "the goal is " : "goal 0 is ") + faults[1].message;
  return endpoints;
}
}  // namespace gpu_planning_scene::core
