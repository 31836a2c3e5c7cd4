#include "collision/report/scene_text.h"
#include "gpu_planning_scene/octomap.h"
#include "model/full_states.h"
#include "model/robot_text.h"
#include "node/checks/check_services.h"
#include "node/endpoints/respond.h"

// The service ~get_report.
namespace gpu_planning_scene::core
{
namespace
{
/// Writes the report of `answer`, which must have one, into the response.
void fillReport(const CheckAnswer& answer, GetReport::Response& response)
{
  const SceneReport& report = *answer.report;
  response.lines = describeScene(*answer.scene, report, answer.device);
  if (!report.decided.empty())
    response.lines.emplace_back(
        "the states decided on the CPU are those of small requests; another checker decides large requests");
  response.lines.emplace_back("not modelled: padding between links");
  const std::vector<std::string> robot = describeRobot(*answer.scene->robot);
  response.lines.insert(response.lines.end(), robot.begin(), robot.end());
  const auto add = [&response](const char* name, std::size_t value)
  {
    response.names.emplace_back(name);
    response.values.push_back(static_cast<double>(value));
  };
  add("self_pairs", report.self_pairs);
  add("world_pairs", report.world_pairs);
  add("allowed_self_pairs", report.allowed_self_pairs);
  add("allowed_world_pairs", report.allowed_world_pairs);
  add("touch_pairs", report.touch_pairs);
  add("pairs_outside_group", report.pairs_outside_group);
  add("links_without_shapes", report.links_without_shapes);
  add("unreachable_self_pairs", report.unreachable_self_pairs);
  add("unreachable_world_pairs", report.unreachable_world_pairs);
  add("unreachable_objects", report.unreachable_objects);
  add("rigid_pairs", report.rigid_pairs);
  add("always_colliding", report.always_colliding ? 1 : 0);
  add("colliding_in_samples", report.colliding_in_samples.size());
  add("triangles", report.triangles);
  add("trees", report.trees);
  add("shared_trees", report.shared_trees);
  add("objects", answer.scene->objects.size());
  add("attached_objects", answer.scene->attached.size());
  const WorldObject* octomap = answer.scene->findObject(kOctomapId);
  add("voxels", octomap == nullptr ? 0 : octomap->shapes.size());
  add("variables", answer.scene->robot->variables().size());
  response.scene_revision = answer.result.revision;
}
}  // namespace

GetReport::Response CheckServices::report(const GetReport::Request& request)
{
  return respond<GetReport::Response>(
      [&](GetReport::Response& response)
      {
        CheckJob job;
        job.group = request.group;
        job.report = true;
        const CheckAnswer answer = answerOf(std::move(job));
        fillReport(answer, response);
        const Snapshot now = store_.snapshot();
        if (std::string assumed = assumedPassiveJoints(*now.scene->robot, now.known); !assumed.empty())
          response.lines.push_back(std::move(assumed));
      });
}
}  // namespace gpu_planning_scene::core
