// A node with the slider robot and the parameters of strict_parameters.yaml and strict_planning.yaml: MoveIt's padding
// and scale, limits, and point clouds.

#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>

#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class Parameters : public RunningNode
{
 public:
  static bool isFreeAt(double slide) { return check({slide, 0.0}).valid.at(0) != 0; }

  /// A wall whose faces are at x = 0.99 and 1.01 m.
  static CollisionObject wall() { return boxObject("wall", {1.0, 0.0, 0.0}, 0.02); }

  static sensor_msgs::PointCloud2 cloud(const std::vector<Eigen::Vector3f>& points)
  {
    sensor_msgs::PointCloud2 message;
    message.header.frame_id = robot->planningFrame();
    message.height = 1;
    message.width = static_cast<std::uint32_t>(points.size());
    message.point_step = 12;
    message.row_step = message.point_step * message.width;
    for (const char* name : {"x", "y", "z"})
    {
      sensor_msgs::PointField field;
      field.name = name;
      field.offset = static_cast<std::uint32_t>(4 * message.fields.size());
      field.datatype = sensor_msgs::PointField::FLOAT32;
      field.count = 1;
      message.fields.push_back(field);
    }
    message.data.resize(message.row_step);
    for (std::size_t i = 0; i < points.size(); ++i)
      std::memcpy(message.data.data() + 12 * i, points[i].data(), 12);
    return message;
  }
};

TEST_F(Parameters, PaddingAndScaleOfLinksAreThoseOfRobotDescriptionPlanning)
{
  std::map<std::string, double> padding;
  std::map<std::string, double> scale;
  const PlanningSceneMessage now = scene(PlanningSceneComponents::LINK_PADDING_AND_SCALING);
  for (const LinkPadding& entry : now.link_padding)
    padding[entry.link_name] = entry.padding;
  for (const LinkScale& entry : now.link_scale)
    scale[entry.link_name] = entry.scale;
  EXPECT_EQ(0.1, padding["cart"]);
  EXPECT_EQ(0.05, padding["pole"]);
  EXPECT_EQ(1.0, scale["cart"]);
  EXPECT_EQ(2.0, scale["pole"]);
}

TEST_F(Parameters, ObjectsHaveTheirOwnDefaultPadding)
{
  apply(diffWith(wall()));
  // The cart extends 0.1 m ahead. Its padding is 0.1 m, the wall's padding 0.03 m.
  EXPECT_TRUE(isFreeAt(0.99 - 0.1 - 0.13 - 0.001));
  EXPECT_FALSE(isFreeAt(0.99 - 0.1 - 0.13 + 0.001));
}

TEST_F(Parameters, CarriedObjectsHaveTheirLinksPaddingAndTheirOwn)
{
  apply(diffWith(wall()));
  AttachedCollisionObject bumper;
  bumper.link_name = "cart";
  bumper.object = boxObject("bumper", {0.2, 0.0, 0.0}, 0.1);
  bumper.object.header.frame_id = "cart";
  apply(diffWith(bumper));
  // The bumper extends 0.25 m ahead. The paddings are 0.1 m (cart), 0.02 m (bumper) and 0.03 m (wall).
  EXPECT_TRUE(isFreeAt(0.99 - 0.25 - 0.15 - 0.001));
  EXPECT_FALSE(isFreeAt(0.99 - 0.25 - 0.15 + 0.001));
}

TEST_F(Parameters, ExceededLimitsAreNamed)
{
  const auto response = call<CheckStates>("check_states", stateRequest(std::vector<double>(202, 0.0)));
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, response.status);
  EXPECT_NE(std::string::npos, response.message.find("limits/request_states")) << response.message;

  CheckStates::Request inspected = stateRequest(std::vector<double>(20, 0.0));
  inspected.clearance = true;
  const auto refused = call<CheckStates>("check_states", inspected);
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, refused.status);
  EXPECT_NE(std::string::npos, refused.message.find("limits/inspected_states")) << refused.message;

  CheckStates::Request allowing = stateRequest(free_state);
  allowing.allowed_collision_matrix.entry_names = {std::string(21, 'x')};
  allowing.allowed_collision_matrix.entry_values.resize(1);
  allowing.allowed_collision_matrix.entry_values[0].enabled = {0};
  const auto long_name = call<CheckStates>("check_states", allowing);
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, long_name.status);
  EXPECT_NE(std::string::npos, long_name.message.find("limits/name_length")) << long_name.message;

  CheckMotions::Request motion;
  motion.joint_names = {"slide", "turn"};
  motion.starts = {-1.0, 0.0};
  motion.ends = {1.0, 0.0};
  motion.resolution = motion.translation_resolution = 0.1;
  const auto given_up = call<CheckMotions>("check_motions", motion);
  EXPECT_TRUE(given_up.success);
  EXPECT_EQ((std::vector<std::uint8_t>{0}), given_up.valid);
  EXPECT_EQ((std::vector<std::uint8_t>{1}), given_up.given_up);
  EXPECT_NE(std::string::npos, given_up.message.find("limits/motion_checks")) << given_up.message;

  PlanningSceneMessage four = diffScene();
  for (const char* id : {"a", "b", "c", "d"})
    four.world.collision_objects.push_back(boxObject(id, farAway(), 0.02));
  expectRefusal(four, "limits/objects");
  expectRefusal(diffWith(boxObject(std::string(21, 'x'), farAway(), 0.02)), "limits/name_length");
}

TEST_F(Parameters, AMessageThatIsTooLongIsRefusedAndTheNodeLivesOn)
{
  expectRefusal(diffWith(boxObject(std::string(300000, 'x'), farAway(), 0.02)), "limits/message_size");
  EXPECT_TRUE(isFreeAt(0.0));
}

TEST_F(Parameters, APointCloudIsAnObstacleWithoutTheRobotsOwnPoints)
{
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<sensor_msgs::PointCloud2>("/points", 1);
  for (int i = 0; i < 100 && publisher.getNumSubscribers() == 0; ++i)
    ros::WallDuration(0.1).sleep();
  const Eigen::Vector3f on_the_cart(static_cast<float>(free_state[0]) + 0.1F, 0.0F, 0.0F);
  const float far = free_state[0] > 0.0 ? -1.5F : 1.5F;
  publisher.publish(cloud({on_the_cart, {far, 0.0F, 0.0F}}));
  for (int i = 0; i < 100 && scene().world.collision_objects.empty(); ++i)
    ros::WallDuration(0.1).sleep();
  const PlanningSceneMessage now = scene();
  ASSERT_EQ(1u, now.world.collision_objects.size());
  EXPECT_EQ("cloud", now.world.collision_objects[0].id);
  EXPECT_EQ(1u, now.world.collision_objects[0].primitives.size()) << "the point on the cart is its own";
  EXPECT_TRUE(isFree());
  EXPECT_FALSE(isFreeAt(far));

  PlanningSceneMessage moved = diffScene();
  moved.world.collision_objects = {objectOperation("cloud", CollisionObject::MOVE)};
  moved.world.collision_objects[0].pose = poseAt(Eigen::Vector3d(0.0, 1.0, 0.0));
  apply(moved);
  EXPECT_TRUE(isFreeAt(far));
  publisher.publish(cloud({on_the_cart, {far, 0.0F, 0.0F}}));
  EXPECT_TRUE(becomes([far] { return !isFreeAt(far); })) << "an equal cloud brings the moved object back";

  publisher.publish(cloud({on_the_cart}));
  for (int i = 0; i < 100 && !scene().world.collision_objects.empty(); ++i)
    ros::WallDuration(0.1).sleep();
  EXPECT_TRUE(isFreeAt(far)) << "a new cloud replaces the old";

  // The cart was at its free state at 100 s and is far away now. The point on it still belongs to the robot.
  const ros::Publisher joint_states = node.advertise<sensor_msgs::JointState>("/joint_states", 1);
  for (int i = 0; i < 100 && joint_states.getNumSubscribers() == 0; ++i)
    ros::WallDuration(0.1).sleep();
  const auto move_to = [&](double seconds, double slide)
  {
    sensor_msgs::JointState message;
    message.header.stamp = ros::Time(seconds);
    message.name = {robot->variables()[0].name};
    message.position = {slide};
    joint_states.publish(message);
    const auto there = [&] { return scene().robot_state.joint_state.position.at(0) == slide; };
    for (int i = 0; i < 100 && !there(); ++i)
      ros::WallDuration(0.1).sleep();
    ASSERT_TRUE(there());
  };
  move_to(100.0, free_state[0]);
  move_to(101.0, double{far});
  sensor_msgs::PointCloud2 earlier = cloud({on_the_cart, {0.0F, 0.0F, 5.0F}});
  earlier.header.stamp = ros::Time(100.1);
  publisher.publish(earlier);
  for (int i = 0; i < 100 && scene().world.collision_objects.empty(); ++i)
    ros::WallDuration(0.1).sleep();
  ASSERT_EQ(1u, scene().world.collision_objects.size());
  EXPECT_EQ(1u, scene().world.collision_objects[0].primitives.size());
}
}  // namespace
}  // namespace gpu_planning_scene::core
