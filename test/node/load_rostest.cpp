// The answers of a node that is overloaded, and of a node that is ended while it works.

#include <atomic>
#include <thread>

#include <diagnostic_msgs/DiagnosticArray.h>

#include "node/child_node.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class Load : public RunningNode
{
 public:
  static CheckStates requestOf(std::size_t states)
  {
    CheckStates call;
    std::vector<double> many;
    for (std::size_t i = 0; i < states; ++i)
      many.insert(many.end(), free_state.begin(), free_state.end());
    call.request = stateRequest(many);
    return call;
  }

  /// Calls `ask` with the thread's number on `threads` threads at once.
  template <class Ask>
  static void together(int threads, Ask ask)
  {
    std::vector<std::thread> clients;
    clients.reserve(static_cast<std::size_t>(threads));
    for (int i = 0; i < threads; ++i)
      clients.emplace_back(ask, i);
    for (std::thread& client : clients)
      client.join();
  }

  /// Publishes `count` objects as fast as possible.
  static void publishBoxes(ros::Publisher& publisher, int count)
  {
    while (publisher.getNumSubscribers() == 0)
      ros::WallDuration(0.02).sleep();
    for (int i = 0; i < count; ++i)
      publisher.publish(boxObject("box " + std::to_string(i), farAway(), 0.01));
  }

  static std::size_t objectsOf(const ChildNode& node)
  {
    GetPlanningScene call;
    call.request.components.components = PlanningSceneComponents::WORLD_OBJECT_NAMES;
    EXPECT_TRUE(callPersistently(node.service("get_planning_scene"), call));
    return call.response.scene.world.collision_objects.size();
  }
};

TEST_F(Load, NoObjectOfManyOnATopicIsLost)
{
  constexpr int kObjects = 5000;
  const ChildNode node("quick_node", {"_device:=cpu"});
  ros::NodeHandle client;
  ros::Publisher publisher = client.advertise<CollisionObject>(node.service("collision_object"), kObjects + 1);
  publishBoxes(publisher, kObjects);
  publisher.publish(objectOperation("no such object", CollisionObject::REMOVE));  // must not affect the other changes
  EXPECT_TRUE(becomes([&] { return objectsOf(node) == kObjects; })) << objectsOf(node) << " objects are there";
}

TEST_F(Load, ObjectsThatAreTooManyAreCountedAsRefused)
{
  constexpr int kObjects = 5000;
  const ChildNode node("small_node", {"_device:=cpu", "_limits/waiting_changes:=5"});
  std::atomic<int> refused{0};
  ros::NodeHandle client;
  const ros::Subscriber diagnostics = client.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10,
      [&refused](const diagnostic_msgs::DiagnosticArray::ConstPtr& message)
      {
        for (const auto& value : message->status.at(0).values)
          if (message->status[0].name == "small_node: checks" && value.key == "refused")
            refused = std::stoi(value.value);
      });
  ros::Publisher publisher = client.advertise<CollisionObject>(node.service("collision_object"), kObjects);
  publishBoxes(publisher, kObjects);
  EXPECT_TRUE(becomes([&] { return refused + static_cast<int>(objectsOf(node)) == kObjects; }))
      << refused << " objects are told as refused, and " << objectsOf(node) << " are there";
  EXPECT_GT(refused, 0);
}

TEST_F(Load, OverloadAnswersBusyAtOnce)
{
  const ChildNode node("hurried_node", {"_device:=cpu", "_limits/waiting_requests:=1", "_small_request:=1"});
  std::atomic<int> right{0}, busy{0}, other{0};
  together(12,
           [&](int)
           {
             CheckStates call = requestOf(200000);
             // roscpp may lose the first call of a connection (persistent_call.h). So a small request opens it.
             CheckStates first = requestOf(1);
             callPersistently(node.service("check_states"), first);
             if (!callPersistently(node.service("check_states"), call))
               ++other;
             else if (call.response.success)
               ++(call.response.valid.size() == 200000 ? right : other);
             else
               ++(call.response.status == AnswerStatus::BUSY ? busy : other);
           });
  EXPECT_EQ(0, other) << "calls with neither an answer nor \"busy\"";
  EXPECT_GE(right, 1);
  EXPECT_GE(busy, 1);

  CheckStates after = requestOf(1);
  ASSERT_TRUE(callPersistently(node.service("check_states"), after));
  EXPECT_TRUE(after.response.success) << after.response.message;
}

/// Ends a node that has 8 requests of 300,000 states. Each request must be answered.
template <class End>
void expectAllAnswered(ChildNode& node, End end)
{
  std::atomic<int> right{0}, told{0}, other{0};
  std::atomic<int> asked{0};
  std::thread ending(
      [&]
      {
        while (asked < 8)
          ros::WallDuration(0.01).sleep();
        ros::WallDuration(0.3).sleep();  // long enough for all requests to arrive
        end(node);
      });
  Load::together(8,
                 [&](int)
                 {
                   CheckStates warm = Load::requestOf(1);
                   callPersistently(node.service("check_states"), warm);
                   CheckStates call = Load::requestOf(300000);
                   ++asked;
                   if (!callPersistently(node.service("check_states"), call))
                     ++other;
                   else if (call.response.success)
                     ++(call.response.valid.size() == 300000 ? right : other);
                   else
                     ++(call.response.status == AnswerStatus::SHUTTING_DOWN ? told : other);
                 });
  ending.join();
  EXPECT_EQ(0, other) << "requests that were taken and got no reply, or a wrong one";
  EXPECT_EQ(8, right + told);
  EXPECT_EQ(0, node.wait(10.0)) << "its exit code";
}

TEST_F(Load, ANodeThatIsEndedAnswersAllThatItHasTaken)
{
  ChildNode node("ended_node", {"_device:=cpu", "_small_request:=1"});
  expectAllAnswered(node, [](const ChildNode& ended) { ended.interrupt(); });
}

TEST_F(Load, ANodeThatRosnodeKillEndsAnswersAllThatItHasTaken)
{
  ChildNode node("killed_node", {"_device:=cpu", "_small_request:=1"});
  expectAllAnswered(node, [](const ChildNode& ended) { ended.askToShutDown(); });
}

TEST_F(Load, ANodeThatIsEndedAnswersRequestsThatNoThreadHasTakenYet)
{
  ChildNode node("waiting_node", {"_device:=cpu", "_tf_timeout:=3"});
  std::atomic<int> told{0}, asked{0};
  std::thread ending(
      [&]
      {
        while (asked < 12)
          ros::WallDuration(0.01).sleep();
        ros::WallDuration(0.3).sleep();
        node.interrupt();
      });
  together(12,
           [&](int)
           {
             GetPlanningScene warm;
             callPersistently(node.service("get_planning_scene"), warm);
             ApplyPlanningScene call;
             CollisionObject box = boxObject("box", farAway(), 0.1);
             box.header.frame_id = "nowhere";
             call.request.scene = diffWith(box);
             ++asked;
             if (callPersistently(node.service("apply_planning_scene"), call))
               ++told;
           });
  ending.join();
  EXPECT_EQ(12, told) << "replies to 12 requests, which 4 threads answer";
  EXPECT_EQ(0, node.wait(10.0)) << "its exit code";
}

TEST_F(Load, ANodeEndsSoonThoughChangesWaitForFrames)
{
  ChildNode node("lost_node", {"_device:=cpu", "_tf_timeout:=2"});
  ros::NodeHandle client;
  ros::Publisher publisher = client.advertise<CollisionObject>(node.service("collision_object"), 100);
  while (publisher.getNumSubscribers() == 0)
    ros::WallDuration(0.02).sleep();
  for (unsigned i = 1; i <= 100; ++i)
  {
    CollisionObject box = boxObject("box", farAway(), 0.1);
    box.header.frame_id = "nowhere";
    box.header.stamp.sec = i;
    publisher.publish(box);
  }
  ros::WallDuration(0.3).sleep();
  node.interrupt();
  EXPECT_EQ(0, node.wait(10.0)) << "its exit code";
}
}  // namespace
}  // namespace gpu_planning_scene::core
