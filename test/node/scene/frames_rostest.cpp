// The frames in which an object's pose may be given.

#include <thread>

#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class Frames : public RunningNode
{
 public:
  /// A box of 2 cm at `place` in the frame.
  static CollisionObject boxIn(const std::string& frame, const Eigen::Vector3d& place, const std::string& id = "box")
  {
    CollisionObject object = boxObject(id, place, 0.02);
    object.header.frame_id = frame;
    return object;
  }

  static geometry_msgs::TransformStamped transform(const std::string& child, const Eigen::Vector3d& place)
  {
    geometry_msgs::TransformStamped message;
    message.header.stamp = ros::Time::now();
    message.header.frame_id = robot->planningFrame();
    message.child_frame_id = child;
    message.transform.translation.x = place.x();
    message.transform.translation.y = place.y();
    message.transform.translation.z = place.z();
    message.transform.rotation.w = 1.0;
    return message;
  }
};

TEST_F(Frames, APoseMayBeInThePlanningFrameByName)
{
  apply(diffWith(boxIn(robot->planningFrame(), tipPoint())));
  EXPECT_FALSE(isFree());
  apply(diffWith(boxIn("/" + robot->planningFrame(), farAway())));
  EXPECT_TRUE(isFree());
}

TEST_F(Frames, APoseMayBeInALinksFrameAsTheRobotStands)
{
  apply(diffWith(boxIn(tip, linkPose(tip, free_state).inverse() * tipPoint())));
  EXPECT_FALSE(isFree());
}

TEST_F(Frames, APoseMayBeInAnObjectsFrameOrItsSubframe)
{
  CollisionObject table = boxIn("", farAway(), "table");
  table.subframe_names.emplace_back("corner");
  table.subframe_poses.push_back(poseAt(Eigen::Vector3d(0.0, 0.0, 1.0)));
  apply(diffWith(table));
  apply(diffWith(boxIn("table", tipPoint() - farAway())));
  EXPECT_FALSE(isFree());
  apply(diffWith(boxIn("table", farAway())));
  EXPECT_TRUE(isFree());
  apply(diffWith(boxIn("table/corner", tipPoint() - farAway() - Eigen::Vector3d(0.0, 0.0, 1.0))));
  EXPECT_FALSE(isFree());
  expectRefusal(diffWith(boxIn("table/no_such_corner", farAway())), "no_such_corner");
}

TEST_F(Frames, APoseMayBeInAFixedFrameOfTheScene)
{
  PlanningSceneMessage change = diffScene();
  change.fixed_frame_transforms.push_back(transform("shelf", farAway()));
  apply(change);
  apply(diffWith(boxIn("shelf", tipPoint() - farAway())));
  EXPECT_FALSE(isFree());
}

TEST_F(Frames, APoseMayBeInAFrameOfTf)
{
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(transform("camera", farAway()));
  ros::WallDuration(0.5).sleep();
  apply(diffWith(boxIn("camera", tipPoint() - farAway())));
  EXPECT_FALSE(isFree());
}

TEST_F(Frames, AFrameOfTfIsLookedUpAtItsStamp)
{
  tf2_ros::TransformBroadcaster broadcaster;
  ros::WallDuration(2.0).sleep();  // time for the node to subscribe
  const ros::Time then = ros::Time::now();
  geometry_msgs::TransformStamped message = transform("wagon", farAway());
  for (const double seconds : {-1.0, 0.0, 0.1})
  {
    message.header.stamp = then + ros::Duration(seconds);
    message.transform.translation.x = farAway().x() + 10.0 * seconds;
    broadcaster.sendTransform(message);
    ros::WallDuration(0.2).sleep();
  }
  CollisionObject box = boxIn("wagon", tipPoint() - farAway());
  box.header.stamp = then;
  apply(diffWith(box));
  EXPECT_FALSE(isFree());
  box.header.stamp = then + ros::Duration(0.1);
  apply(diffWith(box));
  EXPECT_TRUE(isFree()) << "by then it is a metre farther";
}

TEST_F(Frames, AFrameThatComesWithinTheTimeoutIsWaitedFor)
{
  tf2_ros::StaticTransformBroadcaster broadcaster;
  std::thread late(
      [&]
      {
        ros::WallDuration(0.3).sleep();
        broadcaster.sendTransform(transform("late_camera", farAway()));
      });
  apply(diffWith(boxIn("late_camera", tipPoint() - farAway())));
  late.join();
  EXPECT_FALSE(isFree());
}

TEST_F(Frames, AFrameThatNobodyKnowsIsAClearErrorAfterTheTimeout)
{
  expectRefusal(diffWith(boxIn("nowhere", farAway())), "frame 'nowhere'", AnswerStatus::UNAVAILABLE);
  expectRefusal(diffWith(boxIn("nowhere_at_all", farAway())),
                "frame 'nowhere_at_all' is neither in the scene nor on tf; name a link, an object, OBJECT/SUBFRAME, a "
                "fixed frame of the scene, or a frame of tf (waited 0.5 s: tf_timeout)",
                AnswerStatus::UNAVAILABLE);
}

TEST_F(Frames, AMistypedFrameIsAnsweredWithTheNearestName)
{
  expectRefusal(diffWith(boxIn(tip + "x", farAway())), "is neither in the scene nor on tf; did you mean '" + tip + "'?",
                AnswerStatus::UNAVAILABLE);
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(transform("overhead_camera", farAway()));
  ros::WallDuration(0.5).sleep();
  expectRefusal(diffWith(boxIn("overhaed_camera", farAway())), "did you mean 'overhead_camera'?",
                AnswerStatus::UNAVAILABLE);
}

TEST_F(Frames, AFrameThatTfDoesNotConnectOrHasNoLongerIsNamed)
{
  tf2_ros::StaticTransformBroadcaster static_broadcaster;
  geometry_msgs::TransformStamped apart = transform("palm_tree", farAway());
  apart.header.frame_id = "island";
  static_broadcaster.sendTransform({apart, transform("mainland", farAway())});
  tf2_ros::TransformBroadcaster broadcaster;
  ros::WallDuration(2.0).sleep();  // time for the node to subscribe
  const ros::Time now = ros::Time::now();
  geometry_msgs::TransformStamped message = transform("tram", farAway());
  for (const double seconds : {-0.2, 0.0})
  {
    message.header.stamp = now + ros::Duration(seconds);
    broadcaster.sendTransform(message);
  }
  ros::WallDuration(0.5).sleep();
  expectRefusal(diffWith(boxIn("palm_tree", farAway())),
                "frame 'palm_tree' and the planning frame '" + robot->planningFrame() +
                    "' are on tf, but not connected; publish the transform between them",
                AnswerStatus::UNAVAILABLE);
  CollisionObject box = boxIn("tram", farAway());
  box.header.stamp = now - ros::Duration(100.0);
  expectRefusal(diffWith(box), "give a time that tf still has, or 0 for the latest");
  box.header.stamp = now + ros::Duration(100.0);
  expectRefusal(diffWith(box), "give a time that tf still has, or 0 for the latest", AnswerStatus::UNAVAILABLE);
}
}  // namespace
}  // namespace gpu_planning_scene::core
