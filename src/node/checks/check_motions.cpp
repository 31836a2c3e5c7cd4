#include <algorithm>
#include <tuple>
#include <utility>

#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/planning/path_constraints.h"
#include "model/full_states.h"
#include "model/joint_limits.h"
#include "node/checks/check_services.h"
#include "node/checks/requested_motions.h"
#include "node/checks/requested_scene.h"
#include "node/endpoints/respond.h"
#include "node/messages/requested_constraints.h"
#include "node/messages/requested_ends.h"
#include "service/service_errors.h"

// The service ~check_motions.
namespace gpu_planning_scene::core
{
CheckMotions::Response CheckServices::checkMotions(const CheckMotions::Request& request)
{
  return respond<CheckMotions::Response>(
      [&](CheckMotions::Response& response)
      {
        memory_.require();
        const RequestedScene scene =
            requestedScene(store_, others_.pose, request.scene_diff, request.allowed_collision_matrix);
        const Snapshot& now = scene.now;
        const RobotModel& robot = *now.scene->robot;
        const PartialState current = now.partialState();
        RequestedEnds given = requestedEnds(
            robot, request, current, [this](std::size_t count) { server_.requireStateCount(count); });
        CheckJob job;
        job.columns = given.columns;
        const std::size_t count = given.count;
        const std::vector<double> starts = fullStates(robot, job.columns, given.starts.data(), count, current);
        const std::vector<double> ends = fullStates(robot, job.columns, given.ends.data(), count, current);
        validateStates(robot, starts.data(), count, "motion");
        validateStates(robot, ends.data(), count, "motion");
        if (const std::string sideways = sidewaysMotion(robot, starts.data(), ends.data(), count, "motion");
            !sideways.empty())
          throw Error(sideways);
        std::tie(job.motions, job.samples) =
            requestedMotions({request.motion_rule, request.resolution, request.translation_resolution, "motion"}, robot,
                             starts.data(), ends.data(), count, options_);
        const MotionRule motion_rule = job.motions->rule;
        const std::string assumed_base = now.assumedBase(scene.depends_on_state ? std::vector<int>() : job.columns);
        const auto name_of = [](std::size_t row) { return "motion " + std::to_string(row); };
        for (const std::vector<double>* states : {&starts, &ends})
          if (response.message.empty())
            response.message = motion_rule == MotionRule::Bound ? beyondLimits(robot, states->data(), count, name_of)
                                                                : outsideLimits(robot, states->data(), count, name_of);
        const bool are_within = response.message.empty();
        for (const std::vector<double>* rows : {&given.starts, &given.ends})
          if (const auto turned = findManyTurns(robot, job.columns, rows->data(), count);
              turned && response.message.empty())
            response.message = name_of(turned->row) + ": " + turned->text;
        std::vector<std::uint8_t> fulfils;
        const bool is_known = std::all_of(
            current.known.begin(), current.known.end(), [](bool known) { return known; });
        if (const KinematicConstraints constraints =
                requestedPathConstraints(request.path_constraints, *now.scene, request.group,
                                         is_known ? current.values.data() : nullptr, others_);
            !constraints.isEmpty())
        {
          const PathConstraints path(now.scene->robot, request.group, constraints);
          const std::size_t width = robot.variables().size();
          for (std::size_t i = 0; i < count && !stopping_; ++i)
            fulfils.push_back(path.holdAlong(&starts[i * width], &ends[i * width]) ? 1 : 0);
        }
        if (stopping_)
          throw ShuttingDown();
        // The full states above serve to count the samples. For the check, the variables that the request does not name
        // come from the checked snapshot, which may be newer than `now`.
        job.states = std::move(given.starts);
        job.states.insert(job.states.end(), given.ends.begin(), given.ends.end());
        job.group = request.group;
        job.matrix = scene.matrix;
        if (scene.is_changed || !fulfils.empty())
          job.scene = scene.now;  // so that both verdicts are of the same states
        const CheckAnswer answer = answerOf(std::move(job));
        response.fulfils_constraints = fulfils;
        for (std::size_t i = 0; i < answer.motions.size(); ++i)
        {
          const MotionVerdict& verdict = answer.motions[i];
          response.valid.push_back(verdict.valid && (fulfils.empty() || fulfils[i] != 0) ? 1 : 0);
          response.last_valid_fraction.push_back(verdict.last_valid);
          response.first_invalid_fraction.push_back(verdict.first_invalid);
          response.given_up.push_back(verdict.given_up ? 1 : 0);
          const bool collides = verdict.colliding != kNoPair;
          response.body_1.push_back(collides ? answer.scene->bodyName(verdict.colliding[0]) : "");
          response.body_2.push_back(collides ? answer.scene->bodyName(verdict.colliding[1]) : "");
        }
        if (are_within && motion_rule == MotionRule::Bound)
          addWarning(unproven(answer.motions, "motion"), response.message);
        addWarning(givenUp(answer.motions, options_.max_motion_checks, "motion"), response.message);
        addWarnings(scene.warnings, response.message);
        addWarning(assumed_base, response.message);
        response.states_checked = answer.states_checked;
        response.scene_revision = answer.result.revision;
        response.seconds = answer.result.seconds;
      });
}
}  // namespace gpu_planning_scene::core
