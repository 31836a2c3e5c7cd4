// The topics that the node subscribes to, and the topics that it publishes.

#include <mutex>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <sensor_msgs/JointState.h>
#include <visualization_msgs/MarkerArray.h>

#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class Topics : public RunningNode
{
 protected:
  /// Publishes a message as soon as the node has subscribed.
  template <class Message>
  void publish(const std::string& topic, const Message& message)
  {
    if (!publisher_ || publisher_.getTopic() != topic)
      publisher_ = node_.advertise<Message>(topic, 10);
    ASSERT_TRUE(becomes([this] { return publisher_.getNumSubscribers() > 0; })) << "nobody listens to " << topic;
    publisher_.publish(message);
  }

  ros::NodeHandle node_;
  ros::Publisher publisher_;
};

TEST_F(Topics, PlanningSceneTakesChanges)
{
  publish(name("planning_scene"), diffWith(boxObject("box", tipPoint(), 0.02)));
  EXPECT_TRUE(becomes([] { return !isFree(); }));
}

TEST_F(Topics, CollisionObjectTakesObjectsInOrder)
{
  publish(name("collision_object"), boxObject("box", farAway(), 0.02));
  for (int i = 0; i < 20; ++i)
    publish(name("collision_object"), boxObject("box", i % 2 == 0 ? tipPoint() : farAway(), 0.02));
  publish(name("collision_object"), boxObject("last", farAway(), 0.02));
  EXPECT_TRUE(becomes([] { return scene().world.collision_objects.size() == 2; }));
  EXPECT_TRUE(isFree()) << "the last but one of them is far away";
}

TEST_F(Topics, AttachedCollisionObjectAttaches)
{
  AttachedCollisionObject attached;
  attached.link_name = tip;
  attached.object = boxObject("cup", tipPoint(), 0.02);
  publish(name("attached_collision_object"), attached);
  EXPECT_TRUE(becomes([] { return scene().robot_state.attached_collision_objects.size() == 1; }));
}

TEST_F(Topics, JointStatesChangeTheStateAndNotTheRevision)
{
  const std::uint64_t revision = scene().scene_revision;
  sensor_msgs::JointState message = stateMessage(free_state).joint_state;
  message.position[0] += 0.25;
  publish("/joint_states", message);
  EXPECT_TRUE(becomes(
      [&]
      { return scene(PlanningSceneComponents::ROBOT_STATE).robot_state.joint_state.position == message.position; }));
  EXPECT_EQ(revision, scene().scene_revision);
}

TEST_F(Topics, AWrongMessageIsCountedInDiagnosticsAndNothingElse)
{
  std::mutex mutex;
  std::map<std::string, std::string> values;
  const ros::Subscriber subscriber =
      node_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10,
                                                        [&](const diagnostic_msgs::DiagnosticArray::ConstPtr& message)
                                                        {
                                                          const std::lock_guard<std::mutex> lock(mutex);
                                                          for (const auto& value : message->status.at(0).values)
                                                            values[value.key] = value.value;
                                                        });
  const PlanningSceneMessage before = scene();
  publish(name("collision_object"), objectOperation("no such object", CollisionObject::REMOVE));
  EXPECT_TRUE(becomes(
      [&]
      {
        const std::lock_guard<std::mutex> lock(mutex);
        return values["last_refusal"].find("no such object") != std::string::npos;
      }));
  EXPECT_EQ(before, scene());
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_EQ(std::to_string(before.scene_revision), values["scene_revision"]);
  EXPECT_EQ("0", values["objects"]);
  EXPECT_EQ("false", values["on_cpu"]);
  EXPECT_FALSE(values["device"].empty());
  EXPECT_GT(std::stod(values["memory"]), 1e6);
  for (const char* key : {"batches", "states", "states_per_second", "undecided", "waiting_requests", "busy", "errors"})
    EXPECT_EQ(1u, values.count(key)) << key;
}

TEST_F(Topics, AClientThatFollowsTheDiffsHasTheSameScene)
{
  std::mutex mutex;
  std::vector<PlanningSceneMessage> diffs;
  const ros::Subscriber subscriber = node_.subscribe<PlanningSceneMessage>(
      name("monitored_planning_scene_diffs"), 100,
      [&](const PlanningSceneMessage::ConstPtr& message)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        diffs.push_back(*message);
      });
  ASSERT_TRUE(becomes([&] { return subscriber.getNumPublishers() > 0; }));
  ros::WallDuration(0.5).sleep();
  const std::uint64_t first = scene().scene_revision;
  apply(diffWith(boxObject("a", farAway(), 0.02)));
  apply(diffWith(boxObject("b", farAway(), 0.03)));
  CollisionObject moved = objectOperation("a", CollisionObject::MOVE);
  moved.pose = poseAt(tipPoint());
  apply(diffWith(moved));
  AttachedCollisionObject carried;
  carried.link_name = tip;
  carried.touch_links = {base};
  carried.object = objectOperation("a", CollisionObject::ADD);
  apply(diffWith(carried));
  PlanningSceneMessage settings = diffScene();
  settings.link_padding.resize(1);
  settings.link_padding[0].link_name = tip;
  settings.link_padding[0].padding = 0.003;
  settings.allowed_collision_matrix.entry_names = {base, "b"};
  settings.allowed_collision_matrix.entry_values.resize(2);
  settings.allowed_collision_matrix.entry_values[0].enabled = {0, 1};
  settings.allowed_collision_matrix.entry_values[1].enabled = {1, 0};
  settings.robot_state.joint_state.name = {robot->variables()[0].name};
  settings.robot_state.joint_state.position = {free_state[0] + 0.01};
  apply(settings);
  const std::uint64_t last = apply(diffWith(objectOperation("b", CollisionObject::REMOVE)));
  ASSERT_TRUE(becomes(
      [&]
      {
        const std::lock_guard<std::mutex> lock(mutex);
        return !diffs.empty() && diffs.back().scene_revision == last;
      }));
  const PlanningSceneMessage there = scene();
  SetUp();
  const std::lock_guard<std::mutex> lock(mutex);
  std::uint64_t at = first;
  for (const PlanningSceneMessage& diff : diffs)
  {
    if (diff.scene_revision > last)
      break;
    EXPECT_TRUE(diff.is_diff);
    EXPECT_EQ(at, diff.previous_revision) << "no gap";
    at = diff.scene_revision;
    apply(diff);
  }
  EXPECT_EQ(last, at);
  const PlanningSceneMessage here = scene();
  EXPECT_EQ(there.world.collision_objects, here.world.collision_objects);
  EXPECT_EQ(there.robot_state.joint_state, here.robot_state.joint_state);
  ASSERT_EQ(1u, here.robot_state.attached_collision_objects.size());
  const AttachedCollisionObject& expected = there.robot_state.attached_collision_objects.at(0);
  const AttachedCollisionObject& found = here.robot_state.attached_collision_objects[0];
  EXPECT_EQ(expected.object.id, found.object.id);
  EXPECT_EQ(expected.link_name, found.link_name);
  EXPECT_EQ(expected.touch_links, found.touch_links);
  EXPECT_EQ(expected.object.primitives, found.object.primitives);
  EXPECT_NEAR(expected.object.pose.position.x, found.object.pose.position.x, 1e-12);
  EXPECT_NEAR(expected.object.pose.position.z, found.object.pose.position.z, 1e-12);
  EXPECT_EQ(there.link_padding, here.link_padding);
  EXPECT_EQ(there.allowed_collision_matrix, here.allowed_collision_matrix);
}

TEST_F(Topics, ALateSubscriberGetsTheNewestSceneFirst)
{
  apply(diffWith(boxObject("box", farAway(), 0.02)));
  std::mutex mutex;
  PlanningSceneMessage first;
  const ros::Subscriber subscriber =
      node_.subscribe<PlanningSceneMessage>(name("monitored_planning_scene"), 1,
                                            [&](const PlanningSceneMessage::ConstPtr& message)
                                            {
                                              const std::lock_guard<std::mutex> lock(mutex);
                                              if (first.scene_revision == 0)
                                                first = *message;
                                            });
  const PlanningSceneMessage now = scene();
  EXPECT_TRUE(becomes(
      [&]
      {
        const std::lock_guard<std::mutex> lock(mutex);
        return first.scene_revision != 0;
      }));
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_EQ(now.scene_revision, first.scene_revision);
  EXPECT_EQ(now.world.collision_objects, first.world.collision_objects);
  EXPECT_FALSE(first.is_diff);
}

TEST_F(Topics, MarkersShowWhatCollidesInRedAndTheBoxesOfATreeLevel)
{
  std::mutex mutex;
  std::map<std::string, int> counts;  // by namespace; "red": number of red markers in all namespaces
  const ros::Subscriber subscriber = node_.subscribe<visualization_msgs::MarkerArray>(
      name("markers"), 1,
      [&](const visualization_msgs::MarkerArray::ConstPtr& message)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        counts.clear();
        for (const auto& marker : message->markers)
        {
          counts[marker.ns] += marker.action == visualization_msgs::Marker::ADD ? 1 : 0;
          counts["red"] += marker.color.r > 0.8F && marker.color.g < 0.3F && marker.color.b < 0.3F ? 1 : 0;
        }
      });
  const auto drawn = [&](const std::string& what)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    return counts[what];
  };
  EXPECT_TRUE(becomes([&] { return drawn("robot") > 0; }));
  EXPECT_EQ(0, drawn("red"));
  EXPECT_EQ(0, drawn("tree"));
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  EXPECT_TRUE(becomes([&] { return drawn("red") > 0 && drawn("objects") > 0 && drawn("contacts") > 0; }));
  ShowTreeLevel::Request request;
  request.level = 1;
  EXPECT_TRUE(call<ShowTreeLevel>("show_tree_level", request).success);
  EXPECT_TRUE(becomes([&] { return drawn("tree") > 0; }));
  request.body = "no such body";
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, call<ShowTreeLevel>("show_tree_level", request).status);
  request = ShowTreeLevel::Request();
  request.level = -1;
  EXPECT_TRUE(call<ShowTreeLevel>("show_tree_level", request).success);
  EXPECT_TRUE(becomes([&] { return drawn("tree") == 0; }));
}
}  // namespace
}  // namespace gpu_planning_scene::core
