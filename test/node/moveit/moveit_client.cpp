#include "node/moveit/moveit_client.h"

#include <moveit/utils/robot_model_test_utils.h>

#include "moveit/moveit_resources.h"
#include "node/moveit/moveit_messages.h"

namespace gpu_planning_scene::core
{
moveit::core::RobotModelPtr moveItPanda()
{
  useMoveItResources();
  return moveit::core::loadTestingRobotModel("panda");
}

moveit_msgs::CollisionObject moveItBox(const std::string& id, double x, double size)
{
  moveit_msgs::CollisionObject object;
  object.id = id;
  object.operation = moveit_msgs::CollisionObject::ADD;
  object.header.frame_id = "world";
  object.pose.position.x = x;
  object.pose.position.z = 0.5;
  object.pose.orientation.w = 1.0;
  object.primitives.resize(1);
  object.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
  object.primitives[0].dimensions.assign(3, size);
  object.primitive_poses.resize(1);
  object.primitive_poses[0].orientation.w = 1.0;
  return object;
}

moveit_msgs::PlanningScene asMoveItMessage(const PlanningSceneMessage& scene)
{
  const MoveItScene written{scene};
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(written));
  ros::serialization::OStream to(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(to, written);
  moveit_msgs::PlanningScene read;
  ros::serialization::IStream from(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(from, read);
  return read;
}
}  // namespace gpu_planning_scene::core
