#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "collision/motion/motions_of_group.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "model/full_states.h"
#include "node/checks/check_services.h"
#include "node/checks/requested_motions.h"
#include "node/checks/requested_scene.h"
#include "node/endpoints/respond.h"
#include "node/messages/requested_states.h"
#include "node/messages/requested_trajectory.h"

// The service ~check_trajectory. The rows of a path are its start and its waypoints; part i goes from row i to row
// i + 1.
namespace gpu_planning_scene::core
{
namespace
{
std::string rowName(std::size_t row)
{
  return row == 0 ? "the start" : "waypoint " + std::to_string(row - 1);
}

/// The start and the waypoints as full states.
std::vector<double> pathOf(const RequestedTrajectory& trajectory, const std::vector<double>& start)
{
  const std::size_t width = start.size();
  std::vector<double> path;
  path.reserve((trajectory.waypoints + 1) * width);
  for (std::size_t row = 0; row <= trajectory.waypoints; ++row)
    path.insert(path.end(), start.begin(), start.end());
  const double* value = trajectory.rows.data();
  for (std::size_t row = 1; row <= trajectory.waypoints; ++row)
    for (const int column : trajectory.columns)
      path[row * width + static_cast<std::size_t>(column)] = *value++;
  return path;
}

void fill(const CheckAnswer& answer, CheckTrajectory::Response& response)
{
  const BatchResult& states = answer.result;
  const auto name_of = [&](const BodyPair& pair, std::size_t side)
  { return pair == kNoPair ? std::string() : answer.scene->bodyName(pair[side]); };
  response.start_valid = states.valid.at(0) != 0;
  response.valid = response.start_valid;
  for (std::size_t row = 1; row < states.valid.size(); ++row)
  {
    response.waypoint_valid.push_back(states.valid[row]);
    response.waypoint_body_1.push_back(name_of(states.valid[row] != 0 ? kNoPair : states.colliding[row], 0));
    response.waypoint_body_2.push_back(name_of(states.valid[row] != 0 ? kNoPair : states.colliding[row], 1));
  }
  for (const MotionVerdict& part : answer.motions)
  {
    response.valid = response.valid && part.valid;
    response.part_valid.push_back(part.valid ? 1 : 0);
    response.last_valid_fraction.push_back(part.last_valid);
    response.first_invalid_fraction.push_back(part.first_invalid);
    response.part_body_1.push_back(name_of(part.colliding, 0));
    response.part_body_2.push_back(name_of(part.colliding, 1));
    response.given_up.push_back(part.given_up ? 1 : 0);
  }
  response.states_checked = answer.states_checked;
  response.scene_revision = states.revision;
  response.seconds = states.seconds;
}

/// The start state of the request. The joint values of a named start are in joint_state.
RobotState startOf(const RobotModel& robot, const CheckTrajectory::Request& request)
{
  RobotState start = request.start_state;
  if (request.named_start.empty())
    return start;
  NamedRow named = requestedNamedState(
      robot, {"named_start", request.named_start},
      !start.joint_state.name.empty() || !start.joint_state.position.empty() ? "start_state.joint_state"
      : !start.multi_dof_joint_state.joint_names.empty() || !start.multi_dof_joint_state.transforms.empty()
          ? "start_state.multi_dof_joint_state"
          : nullptr);
  start.joint_state.name = std::move(named.names);
  start.joint_state.position = std::move(named.values);
  return start;
}
}  // namespace

CheckTrajectory::Response CheckServices::checkTrajectory(const CheckTrajectory::Request& request)
{
  return respond<CheckTrajectory::Response>(
      [&](CheckTrajectory::Response& response)
      {
        memory_.require();
        server_.requireStateCount(
            std::max(request.joint_trajectory.points.size(), request.multi_dof_joint_trajectory.points.size()));
        RequestedScene scene =
            requestedScene(store_, others_.pose, request.scene_diff, request.allowed_collision_matrix,
                           startOf(*store_.snapshot().scene->robot, request));
        const RobotModel& robot = *scene.now.scene->robot;
        const RequestedTrajectory trajectory =
            requestedTrajectory(robot, request.joint_trajectory, request.multi_dof_joint_trajectory);
        requireWholeRotations(robot, trajectory.columns);
        const std::vector<double> start = fullStates(robot, {}, nullptr, 1, scene.now.partialState());
        const std::vector<double> path = pathOf(trajectory, start);
        const std::size_t width = start.size();
        const std::size_t parts = trajectory.waypoints;
        validateStates(robot, path.data() + width, parts, "waypoint");
        requireMotionsOfGroup(robot, request.group, path.data(), path.data() + width, parts, "part");

        CheckJob job;
        job.group = request.group;
        job.is_path = true;
        std::tie(job.motions, job.samples) =
            requestedMotions({request.motion_rule, request.resolution, request.translation_resolution, "part"}, robot,
                             path.data(), path.data() + width, parts, options_);
        const MotionRule rule = job.motions->rule;
        const std::string assumed_base = scene.now.assumedBase({});
        job.states = path;
        job.matrix = scene.matrix;
        job.scene = scene.now;
        const CheckAnswer answer = answerOf(std::move(job));
        fill(answer, response);
        response.motion_rule = rule == MotionRule::Bound ? "bound" : "samples";
        response.message = rule == MotionRule::Bound ? beyondLimits(robot, path.data(), parts + 1, rowName)
                                                     : outsideLimits(robot, path.data(), parts + 1, rowName);
        const bool are_within = response.message.empty();
        addWarning(sidewaysMotion(robot, path.data(), path.data() + width, parts, "part"), response.message);
        if (are_within && rule == MotionRule::Bound)
          addWarning(unproven(answer.motions, "part"), response.message);
        addWarning(givenUp(answer.motions, options_.max_motion_checks, "part"), response.message);
        addWarning(longTurn(robot, path, rowName), response.message);
        addWarnings(scene.warnings, response.message);
        addWarning(assumed_base, response.message);
      });
}
}  // namespace gpu_planning_scene::core
