#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "base/seconds_since.h"
#include "base/text/one_line.h"
#include "gpu_planning_scene/error.h"
#include "model/full_states.h"
#include "model/joint_limits.h"
#include "node/checks/state_warnings.h"
#include "node/endpoints/respond.h"
#include "node/kinematics/kinematics_services.h"
#include "node/messages/requested_poses.h"
#include "node/messages/requested_states.h"

// The service ~compute_ik.
namespace gpu_planning_scene::core
{
namespace
{
std::uint8_t statusOf(IkStatus status)
{
  switch (status)
  {
    case IkStatus::Solved:
      return ComputeIk::Response::SOLVED;
    case IkStatus::InCollision:
      return ComputeIk::Response::IN_COLLISION;
    case IkStatus::NoSolution:
      break;
  }
  return ComputeIk::Response::NO_SOLUTION;
}

CollisionFreeIkOptions searchOptions(const ComputeIk::Request& request)
{
  CollisionFreeIkOptions options;
  if (request.max_solutions != 0)
    options.ik.max_solutions = request.max_solutions;
  if (request.max_attempts != 0)
    options.ik.max_attempts = request.max_attempts;
  options.check_collisions = request.ignore_collisions == 0;
  return options;
}

void addResults(const std::vector<CollisionFreeIkResult>& results, const Group& group, ComputeIk::Response& response)
{
  for (const CollisionFreeIkResult& result : results)
  {
    response.pose_status.push_back(statusOf(result.status));
    response.faults.push_back(shortLine(result.message));
    response.counts.push_back(static_cast<std::uint32_t>(result.states.size()));
    for (const std::vector<double>& state : result.states)
      for (const int variable : group.variables)
        response.solutions.push_back(state[static_cast<std::size_t>(variable)]);
    response.distances.insert(response.distances.end(), result.distances.begin(), result.distances.end());
  }
}
}  // namespace

/// A request, converted, with its scene.
struct KinematicsServices::IkTask
{
  Snapshot now;
  bool is_own_scene;  // the request does not change the scene for itself
  std::string group;
  std::vector<double> seed;
  std::vector<KinematicConstraints> goals;
  CollisionFreeIkOptions options;
  std::vector<std::string> warnings;  // for the answer
};

void KinematicsServices::requireLimits(const ComputeIk::Request& request) const
{
  if (request.poses.empty())
    throw Error("poses is empty; give at least one pose");
  const CollisionFreeIkOptions options = searchOptions(request);
  const std::size_t count = request.poses.size();
  const std::string of = std::to_string(count) + (count == 1 ? " pose" : " poses");
  const auto require = [&](std::size_t for_each, std::size_t limit, const std::string& what, const std::string& name)
  {
    if (for_each > limit / count)
      throw Error(of + " with up to " + std::to_string(for_each) + " " + what + (count == 1 ? "" : " each") +
                  "; a request may have " + std::to_string(limit) + " (limits/" + name +
                  "): send fewer poses per request, or lower max_" + what);
  };
  require(options.ik.max_attempts, options_.max_attempts, "attempts", "ik_attempts");
  require(options.ik.max_solutions, options_.max_solutions, "solutions", "ik_solutions");
  if (request.clearance != 0)
    require(options.ik.max_solutions, options_.max_inspected_states, "solutions", "inspected_states");
}

KinematicsServices::IkTask KinematicsServices::taskOf(const ComputeIk::Request& request) const
{
  requireLimits(request);
  RequestedScene requested = requestedScene(store_, others_.pose, request.scene_diff, {});
  IkTask task{std::move(requested.now), !requested.is_changed,        request.group, {}, {},
              searchOptions(request),   std::move(requested.warnings)};
  const PlanningScene& scene = *task.now.scene;
  const RobotModel& robot = *scene.robot;
  const LinkFrame frame = requestedFrame(scene, request.group, request.link);
  const PoseTolerances tolerances = requestedTolerances({"position_tolerance", request.position_tolerance},
                                                        {"orientation_tolerance", request.orientation_tolerance});

  const PartialState current = task.now.partialState();
  const RequestedState seed = requestedState(robot, {"seed_names", request.seed_names}, {"seed", request.seed},
                                             {"named_seed", request.named_seed}, current, "the seed");
  task.seed = seed.state;
  addStateWarnings(task.now, task.group, seed, "the seed", task.warnings);

  const bool is_known = std::all_of(current.known.begin(), current.known.end(), [](bool known) { return known; });
  PoseReader reader(scene, is_known ? current.values.data() : nullptr, others_.pose);
  for (std::size_t i = 0; i < request.poses.size(); ++i)
    task.goals.push_back(reader.constraints(frame, request.poses[i], tolerances, "pose " + std::to_string(i)));
  return task;
}

std::vector<CollisionFreeIkResult> KinematicsServices::solve(const IkTask& task)
{
  CheckerPool::Lease lease(checkers_, task.now.scene, task.is_own_scene);
  return withLease(lease,
                   [&]
                   {
                     return solveCollisionFree(*task.now.scene, *lease.checker(), task.group, task.goals, task.seed,
                                               task.options, [this] { return stopping_.load(); });
                   });
}

void KinematicsServices::addClearances(const IkTask& task, const std::vector<CollisionFreeIkResult>& results,
                                       ComputeIk::Response& response) const
{
  constexpr std::size_t kStatesOfPart = 64;  // a part takes well below a second, so that the node can stop
  std::vector<double> rows;
  std::size_t count = 0;
  for (const CollisionFreeIkResult& result : results)
    for (const std::vector<double>& state : result.states)
    {
      rows.insert(rows.end(), state.begin(), state.end());
      ++count;
    }
  if (count == 0)
    return;
  const std::shared_ptr<const StateInspector> inspector = inspector_of_(task.now.scene);
  for (std::size_t i = 0; i < count; i += kStatesOfPart)
  {
    refuseIfStopping();
    for (const Clearance& clearance :
         inspector->clearances(rows.data() + i * task.seed.size(), std::min(kStatesOfPart, count - i), task.group))
    {
      response.clearance_world.push_back(clearance.world);
      response.clearance_self.push_back(clearance.self);
    }
  }
}

ComputeIk::Response KinematicsServices::computeIk(const ComputeIk::Request& request)
{
  return respond<ComputeIk::Response>(
      [&](ComputeIk::Response& response)
      {
        memory_.require();
        const Admission::Pass pass(admission_);
        const IkTask task = taskOf(request);
        const auto start = std::chrono::steady_clock::now();
        const std::vector<CollisionFreeIkResult> results = solve(task);
        const RobotModel& robot = *task.now.scene->robot;
        const Group& group = robot.group(task.group);
        for (const int variable : group.variables)
          response.joint_names.push_back(robot.variables()[static_cast<std::size_t>(variable)].name);
        addResults(results, group, response);
        if (request.clearance != 0)
          addClearances(task, results, response);
        response.seconds = secondsSince(start);
        response.scene_revision = task.now.scene->revision;
        addWarnings(task.warnings, response.message);
      });
}
}  // namespace gpu_planning_scene::core
