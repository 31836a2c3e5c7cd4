#include "node/moveit/followed_scene.h"

#include <algorithm>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "node/follow/scene_difference.h"
#include "node/moveit/mimic_joints.h"

namespace gpu_planning_scene::core
{
namespace
{
// All bits of PlanningSceneComponents. Some servers leave parts out if the request is 0.
constexpr std::uint32_t kAllComponents = 1023;
std::string listed(const std::set<std::string>& parts)
{
  return nameList({parts.begin(), parts.end()});
}

/// Drops removals of objects that the scene does not have. After a fetch, a message can arrive that is older than the
/// fetched scene.
void dropRemovalsOfMissing(const PlanningScene& scene, SceneChange& change)
{
  const auto is_void = [&scene](const ObjectChange& object)
  {
    return object.operation == Operation::Remove && !object.id.empty() && !scene.findObject(object.id) &&
           !scene.findAttached(object.id);
  };
  const auto is_void_detach = [&scene](const AttachedChange& attached)
  {
    return attached.object.operation == Operation::Remove && !attached.object.id.empty() &&
           !scene.findAttached(attached.object.id);
  };
  change.objects.erase(std::remove_if(change.objects.begin(), change.objects.end(), is_void), change.objects.end());
  std::vector<AttachedChange>& attached = change.state.attached;
  attached.erase(std::remove_if(attached.begin(), attached.end(), is_void_detach), attached.end());
}
}  // namespace

std::set<std::string> partsOf(const SceneChange& change)
{
  std::set<std::string> parts;
  const auto add = [&parts](const char* what, const std::string& name) { parts.insert(what + (" '" + name + "'")); };
  if (!change.name.empty())
    parts.insert("the name");
  if (!change.fixed_frames.empty())
    parts.insert("the fixed frames");
  if (change.matrix)
    parts.insert("the allowed collision matrix");
  for (const AttachedChange& attached : change.state.attached)
    add("object", attached.object.id);
  for (const auto& [link, padding] : change.link_padding)
    add("the padding of", link);
  for (const auto& [link, scale] : change.link_scale)
    add("the scale of", link);
  for (const auto& [id, color] : change.colors)
    add("the colour of", id);
  for (const ObjectChange& object : change.objects)
    add("object", object.id);
  return parts;
}

FollowedScene::FollowedScene(const ros::NodeHandle& node, ros::NodeHandle& timers, const FollowOptions& options,
                             SceneStore& store, SceneServices& changes, SceneStore::Lookup lookup)
  : SceneFollower(node, timers, options), store_(store), changes_(changes), lookup_(std::move(lookup))
{
  store_.keepAges();
  start();
}

FollowedScene::~FollowedScene()
{
  stop();
}

void FollowedScene::apply(const MoveItScene& message)
{
  SceneChange change = changeOf(message.ours);
  if (change.is_diff)
    for (const std::string& part : partsOf(change))
      unconfirmed_.erase(part);
  else
    unconfirmed_.clear();
  dropMeasured(store_.snapshot(), change);
  if (change.is_diff)
    dropRemovalsOfMissing(*store_.snapshot().scene, change);
  changes_.make(change, lookup_);
}

SceneChange FollowedScene::changeOf(const PlanningSceneMessage& message)
{
  const Snapshot now = store_.snapshot();
  const RobotModel& robot = *now.scene->robot;
  if (const std::string fault = mimicFault(message, robot, now.state); !fault.empty())
    mimic_warning_.log(options().topic + ": " + fault);
  SceneChange change = changes_.changeOf(withoutMimicJoints(message, robot));
  // An empty matrix of a whole scene allows nothing in MoveIt. Elsewhere in this package, it means that of the SRDF.
  if (!change.is_diff && !change.matrix)
    change.matrix = AllowedCollisionMatrix();
  return change;
}

MoveItGetScene::Request FollowedScene::request()
{
  MoveItGetScene::Request asked;
  asked.ours.components.components = kAllComponents;
  return asked;
}

/// Makes the differences between the node's scene and the whole one, so that equal parts keep their trees.
void FollowedScene::take(const MoveItGetScene::Response& answer)
{
  const PlanningSceneMessage& whole = answer.ours;
  if (whole.is_diff)
    throw Error("the answer is not a whole scene (is_diff is true)");
  if (whole.robot_model_name.empty())
    throw Error("the answer names no robot (robot_model_name is empty)");
  const SceneChange change = differenceTo(changeOf(whole), store_, lookup_);
  const std::set<std::string> differences = partsOf(change);
  if (!change.is_diff || !differences.empty() || !change.state.variables.empty())
    changes_.make(change, lookup_);
  report(differences);
}

void FollowedScene::report(const std::set<std::string>& differences)
{
  const std::string differed = differences.empty() ? "; it did not differ" : "; it differed in " + listed(differences);
  if (!wasCurrent())
  {
    const std::shared_ptr<const PlanningScene> scene = store_.snapshot().scene;
    ROS_INFO_STREAM("following the scene of " << options().node << ": " << scene->objects.size() << " objects, "
                                              << scene->attached.size() << " attached objects");
  }
  else if (!isCurrent())
    ROS_WARN_STREAM(fault() << "; it was fetched anew" << differed);
  else if (!unconfirmed_.empty())
    ROS_WARN_STREAM("a message of " << options().topic << " was missed: none has named " << listed(unconfirmed_)
                                    << "; the whole scene was fetched anew");
  // Messages that are on their way will name these parts.
  unconfirmed_ = isCurrent() ? differences : std::set<std::string>();
}
}  // namespace gpu_planning_scene::core
