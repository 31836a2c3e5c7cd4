#include <chrono>
#include <cmath>
#include <optional>
#include <string>

#include "base/seconds_since.h"
#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/cartesian_path.h"
#include "gpu_planning_scene/planning/path_timing.h"
#include "model/rigid_pose.h"
#include "node/checks/state_warnings.h"
#include "node/endpoints/respond.h"
#include "node/kinematics/kinematics_services.h"
#include "node/messages/requested_constraints.h"
#include "node/messages/requested_poses.h"
#include "node/messages/requested_timing.h"
#include "node/messages/trajectory_messages.h"

// The service ~compute_cartesian_path.
namespace gpu_planning_scene::core
{
namespace
{
using Request = ComputeCartesianPath::Request;

/// 0 means the default.
double valueOr(double requested, double fallback, const char* field)
{
  if (!(std::isfinite(requested) && requested >= 0.0))
    throw Error(std::string(field) + " is " + numberText(requested) +
                "; it must be at least 0 (0: " + numberText(fallback) + ")");
  return requested == 0.0 ? fallback : requested;
}

void setSteps(const Request& request, CartesianQuery& query)
{
  query.max_step = valueOr(request.max_step, query.max_step, "max_step");
  query.max_rotation_step = valueOr(request.max_rotation_step, query.max_rotation_step, "max_rotation_step");
  query.max_deviation = valueOr(request.max_deviation, query.max_deviation, "max_deviation");
  query.max_rotation_deviation =
      valueOr(request.max_rotation_deviation, query.max_rotation_deviation, "max_rotation_deviation");
  query.max_joint_step = valueOr(request.max_joint_step, query.max_joint_step, "max_joint_step");
}

/// A path, and its times if they are wanted.
struct Lines
{
  CartesianPath path;
  std::optional<TimedPath> timed;
};
}  // namespace

ComputeCartesianPath::Response KinematicsServices::computeCartesianPath(const Request& request)
{
  return respond<ComputeCartesianPath::Response>(
      [&](ComputeCartesianPath::Response& response)
      {
        memory_.require();
        const Admission::Pass pass(admission_);
        const RequestedScene requested = requestedScene(store_, others_.pose, request.scene_diff, {});
        const std::shared_ptr<const PlanningScene>& scene = requested.now.scene;
        std::vector<std::string> warnings = requested.warnings;
        CartesianQuery query;
        query.group = request.group;
        const LinkFrame frame = requestedFrame(*scene, request.group, request.link);
        query.link = frame.link;
        query.frame = frame.pose;
        const RequestedState start =
            requestedState(*scene->robot, {"start_names", request.start_names}, {"start", request.start},
                           {"named_start", request.named_start}, requested.now.partialState(), "the start");
        query.start = start.state;
        addStateWarnings(requested.now, request.group, start, "the start", warnings);
        PoseReader reader(*scene, query.start.data(), others_.pose);
        for (std::size_t i = 0; i < request.waypoints.size(); ++i)
          query.waypoints.push_back(reader.pose(request.waypoints[i], "waypoints[" + std::to_string(i) + "]"));
        setSteps(request, query);
        query.max_rows = options_.max_poses;
        query.check_collisions = request.ignore_collisions == 0;
        query.motions = options_.motions;
        if (!request.motion_rule.empty())
          query.motions.rule = motionRuleFromName(request.motion_rule);
        query.path_constraints =
            requestedPathConstraints(request.path_constraints, *scene, request.group, query.start.data(), others_);

        const auto began = std::chrono::steady_clock::now();
        const std::optional<PathTimingOptions> timing =
            requestedTiming(request, *scene->robot, query.max_deviation, query.motions, query.path_constraints);
        CheckerPool::Lease lease(checkers_, scene, !requested.is_changed);
        const Lines lines = withLease(
            lease,
            [&]
            {
              const auto stop = [this] { return stopping_.load(); };
              Lines found{followLines(scene, lease.checker(), query, stop), {}};
              if (timing)
                found.timed = timePath(*scene, lease.checker(), query.group, found.path.rows, *timing, stop);
              return found;
            });
        response.seconds = secondsSince(began);
        response.fraction = lines.path.fraction;
        response.message = lines.path.message;
        addWarnings(warnings, response.message);
        if (lines.timed)
          addWarning(lines.timed->message, response.message);
        response.trajectory = trajectoryOf(*scene->robot, scene->robot->group(query.group), lines.path.rows,
                                           lines.timed ? &*lines.timed : nullptr);
        response.states_checked = lines.path.states_checked + (lines.timed ? lines.timed->states_checked : 0);
        response.scene_revision = lines.path.revision;
      });
}
}  // namespace gpu_planning_scene::core
