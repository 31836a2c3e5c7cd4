// A node must end although it waits for a clock or a frame that does not come.

#include <atomic>
#include <thread>

#include "node/child_node.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class Stopping : public RunningNode
{
 public:
  static ApplyPlanningScene boxInUnknownFrame()
  {
    CollisionObject box = boxObject("box", farAway(), 0.1);
    box.header.frame_id = "nowhere";
    ApplyPlanningScene call;
    call.request.scene = diffWith(box);
    return call;
  }
};

/// The simulation is paused or has not started: nobody publishes /clock.
TEST_F(Stopping, WorksWithoutAClock)
{
  ros::param::set("/use_sim_time", true);
  ChildNode node("node_without_clock", {"_device:=cpu", "_tf_timeout:=0.2"});
  ros::param::del("/use_sim_time");
  for (int i = 0; i < 5; ++i)  // more than the node's four threads for requests
  {
    ApplyPlanningScene change = boxInUnknownFrame();
    ASSERT_TRUE(callPersistently(node.service("apply_planning_scene"), change));
    EXPECT_EQ(AnswerStatus::UNAVAILABLE, change.response.status);
    EXPECT_NE(std::string::npos, change.response.message.find("tf_timeout")) << change.response.message;
  }
  GetPlanningScene get;
  ASSERT_TRUE(callPersistently(node.service("get_planning_scene"), get));
  node.interrupt();
  EXPECT_EQ(0, node.wait(20.0)) << "its exit code";
}

TEST_F(Stopping, AFrameThatIsWaitedForHoldsUpNoEnd)
{
  ChildNode node("patient_node", {"_device:=cpu", "_tf_timeout:=1000.0"});
  std::atomic<bool> asking{false};
  std::thread ending(
      [&]
      {
        while (!asking)
          ros::WallDuration(0.01).sleep();
        ros::WallDuration(0.5).sleep();  // long enough for the request to arrive
        node.interrupt();
      });
  ApplyPlanningScene change = boxInUnknownFrame();
  ros::service::waitForService(node.service("apply_planning_scene"));
  asking = true;
  EXPECT_TRUE(callPersistently(node.service("apply_planning_scene"), change)) << "no reply";
  ending.join();
  EXPECT_FALSE(change.response.success);
  EXPECT_EQ(AnswerStatus::SHUTTING_DOWN, change.response.status) << change.response.message;
  EXPECT_EQ(0, node.wait(20.0)) << "its exit code";
}
}  // namespace
}  // namespace gpu_planning_scene::core
