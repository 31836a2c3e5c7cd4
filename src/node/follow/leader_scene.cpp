#include "node/follow/leader_scene.h"

#include "node/follow/scene_difference.h"
#include "node/messages/exact_numbers.h"
#include "node/messages/from_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The leader gives each pose in the planning frame or in the frame of a link, so that no frame of tf is needed.
Eigen::Isometry3d noFrame(const StampedFrame& frame)
{
  throw Error("the leader's scene does not have the frame '" + frame.name + "'");
}
}  // namespace

LeaderScene::LeaderScene(const ros::NodeHandle& node, ros::NodeHandle& timers, const FollowOptions& options,
                         std::uint64_t setup, SceneStore& store, SceneServices& changes)
  : SceneFollower(node, timers, options), setup_(setup), store_(store), changes_(changes)
{
  store_.keepAges();
  store_.setOctomapFault(
      [this]
      {
        const std::lock_guard<std::mutex> lock(octomap_mutex_);
        return octomap_fault_;
      });
  start();
}

LeaderScene::~LeaderScene()
{
  stop();
  store_.setOctomapFault({});
}

std::string LeaderScene::changeFault() const
{
  return "the node follows the scene of " + options().node + " (~follow); change the scene there";
}

/// While the scene is known, only the revisions are compared.
GetPlanningScene::Request LeaderScene::request()
{
  GetPlanningScene::Request asked;
  asked.components.components = isCurrent() ? PlanningSceneComponents::SCENE_SETTINGS + 0U : kWholeForFollowers;
  return asked;
}

/// A difference may still be on its way at the time of a comparison, but not at the next one.
void LeaderScene::take(const GetPlanningScene::Response& answer)
{
  if (!answer.success)
    throw Error(options().service + " answers: " + answer.message);
  takeOctomapFault(answer.scene);
  if (!isCurrent())
  {
    takeWhole(answer.scene);
    return;
  }
  const std::uint64_t revision = store_.snapshot().scene->revision;
  if (answer.scene.scene_revision < revision)
    throw Error("its revision went back from " + std::to_string(revision) + " to " +
                std::to_string(answer.scene.scene_revision));
  if (revision < leader_revision_)
    throw Error("the differences from revision " + std::to_string(revision) + " to " +
                std::to_string(leader_revision_) + " are missing");
  leader_revision_ = answer.scene.scene_revision;
}

void LeaderScene::takeOctomapFault(const PlanningSceneMessage& message)
{
  const std::lock_guard<std::mutex> lock(octomap_mutex_);
  octomap_fault_ = message.octomap_fault;
}

void LeaderScene::apply(const PlanningSceneMessage& message)
{
  const std::uint64_t revision = store_.snapshot().scene->revision;
  if (message.scene_revision <= revision)
    return;  // sent before the whole scene was fetched
  takeOctomapFault(message);
  SceneChange change = changeOf(message);
  if (change.is_diff && message.previous_revision != revision)
    throw Error("the differences from revision " + std::to_string(revision) + " to " +
                std::to_string(message.previous_revision) + " are missing");
  if (!change.is_diff)
    change = differenceTo(std::move(change), store_, noFrame);
  dropMeasured(store_.snapshot(), change);
  changes_.follow(change, message.scene_revision);
}

SceneChange LeaderScene::changeOf(const PlanningSceneMessage& message) const
{
  if (message.setup != setup_)
    throw Error("it has another robot, or other default paddings, than this node: give both nodes the " +
                std::string("same parameters"));
  SceneChange change = changeFrom(message, *store_.snapshot().scene->robot, store_.limits(), nullptr);
  takeExactNumbers(message, change);
  return change;
}

void LeaderScene::takeWhole(const PlanningSceneMessage& whole)
{
  const SceneChange full = changeOf(whole);
  if (full.is_diff)
    throw Error("the answer of " + options().service + " is not a whole scene (is_diff is true)");
  changes_.follow(differenceTo(full, store_, noFrame), whole.scene_revision);
  leader_revision_ = whole.scene_revision;
  const std::shared_ptr<const PlanningScene> scene = store_.snapshot().scene;
  if (!wasCurrent())
    ROS_INFO_STREAM("following the scene of " << options().node << ": revision " << scene->revision << " with "
                                              << scene->objects.size() << " objects and " << scene->attached.size()
                                              << " attached objects");
  else
    ROS_WARN_STREAM(fault() << "; it was fetched anew, with revision " << scene->revision);
}
}  // namespace gpu_planning_scene::core
