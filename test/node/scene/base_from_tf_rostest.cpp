// A robot on a virtual joint that nobody sets: the node takes its pose from tf.

#include <tf2_ros/transform_broadcaster.h>

#include "node/child_node.h"
#include "node/node_client.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
class BaseOverTf : public RunningNode
{
 protected:
  static void publishBase(tf2_ros::TransformBroadcaster& broadcaster, double x)
  {
    geometry_msgs::TransformStamped base;
    base.header.stamp = ros::Time::now();
    base.header.frame_id = "hall";
    base.child_frame_id = "rail";
    base.transform.translation.x = x;
    base.transform.rotation.w = 1.0;
    broadcaster.sendTransform(base);
  }

  static CheckStates::Response checkedIn(const ChildNode& node)
  {
    CheckStates call;
    call.request.joint_names = {"slide", "turn"};
    call.request.positions = {0.0, 0.0};
    EXPECT_TRUE(callPersistently(node.service("check_states"), call));
    EXPECT_TRUE(call.response.success) << call.response.message;
    call.response.valid.resize(1);
    return call.response;
  }
};

TEST_F(BaseOverTf, TheRobotStandsWhereTfHasItAndAnOldPoseIsReported)
{
  std::string srdf = sliderSrdf();
  srdf.insert(srdf.find("</robot>"),
              "<virtual_joint name=\"floor\" type=\"planar\" parent_frame=\"hall\" child_link=\"rail\"/>");
  ros::param::set("/srdf_on_floor", srdf);
  const ChildNode node("node_on_floor", {"_device:=cpu", "robot_description_semantic:=/srdf_on_floor"});
  ApplyPlanningScene change;
  change.request.scene = diffWith(boxObject("box", {3.0, 0.0, 0.0}, 0.1));
  ASSERT_TRUE(callPersistently(node.service("apply_planning_scene"), change));
  ASSERT_TRUE(change.response.success) << change.response.message;

  CheckStates::Response answer = checkedIn(node);
  EXPECT_TRUE(answer.valid[0]);
  EXPECT_NE(answer.message.find("tf has no transform from 'hall' to 'rail'"), std::string::npos) << answer.message;

  tf2_ros::TransformBroadcaster broadcaster;
  for (int i = 0; i < 200 && answer.valid[0] != 0; ++i)
  {
    publishBase(broadcaster, 3.0);
    ros::WallDuration(0.05).sleep();
    answer = checkedIn(node);
  }
  EXPECT_FALSE(answer.valid[0]) << "the cart stands in the box";
  EXPECT_EQ("", answer.message);
  ros::WallDuration(1.2).sleep();
  answer = checkedIn(node);
  EXPECT_FALSE(answer.valid[0]);
  EXPECT_NE(answer.message.find("s old"), std::string::npos) << answer.message;
  for (int i = 0; i < 200 && answer.valid[0] == 0; ++i)
  {
    publishBase(broadcaster, 5.0);
    ros::WallDuration(0.05).sleep();
    answer = checkedIn(node);
  }
  EXPECT_TRUE(answer.valid[0]) << "it has driven away";
}
}  // namespace
}  // namespace gpu_planning_scene::core
