#include "node/scene/scene_services.h"

#include <algorithm>

#include "base/text/name_list.h"
#include "base/text/one_line.h"
#include "collision/report/scene_text.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "model/joint_limits.h"
#include "node/endpoints/respond.h"
#include "node/messages/exact_numbers.h"
#include "node/messages/from_messages.h"
#include "node/messages/to_messages.h"
#include "scene/changes/state_dependence.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Whether the change needs memory. Changes that only remove and move objects are made even when memory is short,
/// because a client frees memory with them.
bool takesMemory(const SceneChange& change)
{
  const auto brings = [](const ObjectChange& object) { return !object.shapes.empty() || !object.subframes.empty(); };
  const std::vector<AttachedChange>& attached = change.state.attached;
  return !change.fixed_frames.empty() || change.matrix || !change.link_scale.empty() || !change.colors.empty() ||
         !change.solids.empty() || std::any_of(change.objects.begin(), change.objects.end(), brings) ||
         std::any_of(attached.begin(), attached.end(),
                     [&brings](const AttachedChange& candidate) { return brings(candidate.object); });
}

/// Removes an object of the world; an empty id: all of them.
ObjectChange removalOf(const std::string& id)
{
  ObjectChange removal;
  removal.operation = Operation::Remove;
  removal.id = id;
  return removal;
}

/// All warnings of a change, in one line.
std::string joined(const std::vector<std::string>& warnings)
{
  std::string all;
  for (const std::string& warning : warnings)
    all += (all.empty() ? "" : "; ") + warning;
  return shortLine(all);
}
}  // namespace

SceneServices::SceneServices(SceneStore& store, SceneStore::Lookup lookup, const MemoryGuard& memory,
                             std::uint64_t setup)
  : store_(store), lookup_(std::move(lookup)), memory_(memory), setup_(setup)
{
}

SceneStore::Applied SceneServices::apply(const SceneChange& change, const SceneStore::Lookup& lookup)
{
  if (takesMemory(change))
    memory_.require();
  SceneStore::Applied applied = store_.apply(change, lookup);
  const Snapshot now = store_.snapshot();
  if (const std::string warning = now.assumedBase({}); !warning.empty() && dependsOnRobotState(*now.scene, change))
    applied.warnings.push_back(warning);
  return applied;
}

ApplyPlanningScene::Response SceneServices::apply(const ApplyPlanningScene::Request& request)
{
  return respond<ApplyPlanningScene::Response>(
      [&](ApplyPlanningScene::Response& response)
      {
        std::vector<std::string> warnings;
        const SceneChange change =
            changeFrom(request.scene, *store_.snapshot().scene->robot, store_.limits(), &warnings);
        SceneStore::Applied applied = apply(change, lookup_);
        warnings.insert(warnings.end(), applied.warnings.begin(), applied.warnings.end());
        response.message = joined(warnings);
        response.scene_revision = applied.revision;
      });
}

Clear::Response SceneServices::clear()
{
  return respond<Clear::Response>(
      [&](Clear::Response& response)
      {
        const SceneStore::Applied applied = store_.clear();
        response.message = joined(applied.warnings);
        response.scene_revision = applied.revision;
      });
}

Clear::Response SceneServices::clearOctomap()
{
  return respond<Clear::Response>(
      [&](Clear::Response& response)
      {
        SceneChange change;
        change.is_diff = true;
        change.objects.push_back(removalOf(kOctomapId));
        const SceneStore::Applied applied = apply(change, lookup_);
        response.message = joined(applied.warnings);
        response.scene_revision = applied.revision;
      });
}

GetPlanningScene::Response SceneServices::get(const GetPlanningScene::Request& request) const
{
  GetPlanningScene::Response response;
  const Snapshot now = store_.snapshot();
  const SceneChange change = componentsOf(*now.scene, request.components.components, now.state, now.known);
  response.scene = messageOf(change, *now.scene->robot);
  response.scene.scene_revision = now.scene->revision;
  response.scene.octomap_fault = now.octomap_fault;
  if ((request.components.components & kForFollowers) != 0)
  {
    response.scene.setup = setup_;
    keepExactNumbers(change, *now.scene->robot, response.scene);
  }
  if (!response.scene.robot_state.joint_state.name.empty())
    response.scene.robot_state.joint_state.header.stamp.fromNSec(static_cast<std::uint64_t>(now.stamp));
  response.success = true;
  response.status = AnswerStatus::OK;
  return response;
}

SceneChange SceneServices::changeOf(const PlanningSceneMessage& message) const
{
  std::vector<std::string> warnings;
  SceneChange change = changeFrom(message, *store_.snapshot().scene->robot, store_.limits(), &warnings);
  warnOfMessage(warnings);
  return change;
}

SceneChange SceneServices::changeOf(const CollisionObject& message) const
{
  SceneChange change;
  change.is_diff = true;
  change.objects.push_back(objectChangeFrom(message));
  return change;
}

SceneChange SceneServices::changeOf(const AttachedCollisionObject& message) const
{
  SceneChange change;
  change.is_diff = true;
  change.state.attached.push_back(attachedChangeFrom(message));
  return change;
}

SceneChange SceneServices::changeOf(const PlanningSceneWorld& message) const
{
  PlanningSceneMessage scene;
  scene.is_diff = true;
  scene.robot_state.is_diff = true;
  scene.world = message;
  SceneChange change = changeOf(scene);
  ObjectChange all_objects = removalOf("");
  all_objects.keeps_allowed_collisions = true;
  change.objects.insert(change.objects.begin(), {all_objects, removalOf(kOctomapId)});
  return change;
}

void SceneServices::make(const SceneChange& change, const SceneStore::Lookup& lookup)
{
  warnOfMessage(apply(change, lookup).warnings);
}

void SceneServices::follow(const SceneChange& change, std::uint64_t revision)
{
  if (takesMemory(change))
    memory_.require();
  store_.follow(change, revision);
}

void SceneServices::take(const sensor_msgs::JointState& message)
{
  // Drivers that report only velocities or efforts leave the positions empty.
  if (message.position.empty())
    return;
  if (message.position.size() != message.name.size())
    throw Error(std::to_string(message.position.size()) + " positions for " + std::to_string(message.name.size()) +
                " names");
  std::map<std::string, double> variables;
  std::vector<int> columns;
  std::vector<double> values;
  std::vector<std::string> ignored;
  const std::shared_ptr<const PlanningScene> scene = store_.snapshot().scene;
  for (std::size_t i = 0; i < message.name.size(); ++i)
  {
    variables[message.name[i]] = message.position[i];
    if (const int variable = scene->robot->variableIndex(message.name[i]); variable >= 0)
    {
      columns.push_back(variable);
      values.push_back(message.position[i]);
    }
    else if (scene->robot->jointIndex(message.name[i]) < 0)
      ignored.push_back(message.name[i]);
  }
  if (const auto outside = findValueOutsideLimits(*scene->robot, columns, values.data(), 1))
    joint_warning_.log("joint_states: " + outside->text);
  const std::string jump = store_.updateState(variables, static_cast<std::int64_t>(message.header.stamp.toNSec()));
  if (!jump.empty())
    time_warning_.log("joint_states: " + jump);
  // Other robots may share the topic. While a joint of this one has no value, its name may be among those ignored.
  if (!ignored.empty() && !store_.snapshot().allKnown())
    name_warning_.log("joint_states: ignored, because the robot does not have these joints: " + nameList(ignored));
}
}  // namespace gpu_planning_scene::core
