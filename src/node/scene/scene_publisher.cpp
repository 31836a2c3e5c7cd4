#include "node/scene/scene_publisher.h"

#include <ros/single_subscriber_publisher.h>

#include "node/messages/exact_numbers.h"
#include "node/messages/messages.h"
#include "node/messages/to_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
PlanningSceneMessage fullMessageOf(const Snapshot& now)
{
  PlanningSceneMessage message = messageOf(*now.scene, 0, now.state, now.known);
  message.octomap_fault = now.octomap_fault;
  return message;
}
}  // namespace

ScenePublisher::ScenePublisher(ros::NodeHandle& own, SceneStore& store, double full_scene_period, std::uint64_t setup)
  : store_(store),
    setup_(setup),
    diffs_(own.advertise<PlanningSceneMessage>("monitored_planning_scene_diffs", 100)),
    full_revision_(store_.snapshot().scene->revision)
{
  // roscpp could latch the topic, but a new subscriber would then get the last message, which may be older than the
  // scene.
  full_ = own.advertise<PlanningSceneMessage>(
      "monitored_planning_scene", 1, [this](const ros::SingleSubscriberPublisher& one) { sendTo(one); });
  store_.setListener(
      this, [this](const auto& before, const auto& after) { changed(before, after); });
  timer_ = own.createWallTimer(ros::WallDuration(full_scene_period),
                               [this](const ros::WallTimerEvent&) { publishFull(store_.snapshot()); });
}

ScenePublisher::~ScenePublisher()
{
  store_.setListener(this, {});
}

/// Must not throw: the change has already been made.
void ScenePublisher::changed(const std::shared_ptr<const PlanningScene>& before,
                             const std::shared_ptr<const PlanningScene>& after)
{
  try
  {
    const Snapshot now = store_.snapshot();
    SceneChange change = diffOf(*before, *after);
    if (!change.is_diff)
      publishFull(now);
    if (diffs_.getNumSubscribers() == 0)
      return;
    if (change.is_diff)
      change.state.variables =
          componentsOf(*after, PlanningSceneComponents::ROBOT_STATE, now.state, now.known).state.variables;
    else  // diffOf() leaves out the robot's own matrix
      change = componentsOf(*after, kWholeForFollowers, now.state, now.known);
    PlanningSceneMessage message = messageOf(change, *after->robot);
    message.scene_revision = after->revision;
    message.previous_revision = before->revision;
    message.setup = setup_;
    message.octomap_fault = now.octomap_fault;
    keepExactNumbers(change, *after->robot, message);
    diffs_.publish(message);
  }
  catch (const std::exception& error)
  {
    ROS_ERROR_STREAM("the scene was changed, but the change was not published: " << error.what());
  }
}

void ScenePublisher::sendTo(const ros::SingleSubscriberPublisher& subscriber)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const Snapshot now = store_.snapshot();
  subscriber.publish(fullMessageOf(now));
}

void ScenePublisher::publishFull(const Snapshot& now)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (full_revision_ >= now.scene->revision)
    return;
  full_.publish(fullMessageOf(now));
  full_revision_ = now.scene->revision;
}
}  // namespace gpu_planning_scene::core
