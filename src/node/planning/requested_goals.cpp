#include "node/planning/requested_goals.h"

#include <string>

#include "gpu_planning_scene/error.h"
#include "node/messages/requested_constraints.h"
#include "node/messages/requested_poses.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr PoseTolerances kGoalTolerances{1e-4, 1e-3};  // MoveIt's defaults
}  // namespace

bool hasGoalRegions(const PlanMotion::Request& request)
{
  return !request.goal_poses.empty() || !request.goal_constraints.empty();
}

void addRegions(const PlanMotion::Request& request, const PlanningScene& scene, const OtherFrames& others,
                std::size_t max_goals, PlanningQuery& query)
{
  const std::size_t count = query.goals.size() + request.goal_poses.size() + request.goal_constraints.size();
  if (count > max_goals)
    throw Error(std::to_string(count) + " goals are more than " + std::to_string(max_goals) + " (limits/goals)");
  if (request.goal_poses.empty() && !request.goal_link.empty())
    throw Error("goal_link is '" + request.goal_link + "', but goal_poses is empty; give the poses of the link");
  PoseReader reader(scene, query.start.data(), others.pose);
  const PoseTolerances tolerances =
      requestedTolerances({"goal_position_tolerance", request.goal_position_tolerance},
                          {"goal_orientation_tolerance", request.goal_orientation_tolerance}, kGoalTolerances);
  if (!request.goal_poses.empty())
  {
    const LinkFrame frame = requestedFrame(scene, request.group, request.goal_link);
    for (std::size_t i = 0; i < request.goal_poses.size(); ++i)
      query.goal_regions.push_back(
          reader.constraints(frame, request.goal_poses[i], tolerances, "goal_poses[" + std::to_string(i) + "]"));
  }
  const ConstraintFrames frames = constraintFrames(reader, scene);
  for (std::size_t i = 0; i < request.goal_constraints.size(); ++i)
  {
    const std::string where = "goal_constraints[" + std::to_string(i) + "]";
    query.goal_regions.push_back(constraintsFrom(request.goal_constraints[i], *scene.robot, frames, where));
    if (query.goal_regions.back().isEmpty())
      throw Error(where + " has no constraint; give at least one");
  }
  query.path_constraints =
      requestedPathConstraints(request.path_constraints, scene, request.group, query.start.data(), others);
}
}  // namespace gpu_planning_scene::core
