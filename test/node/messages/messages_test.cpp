// Converts messages to changes of a scene, and scenes to messages. No ROS master is needed.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "model/model_testing.h"
#include "node/messages/exact_numbers.h"
#include "node/messages/from_messages.h"
#include "node/messages/to_messages.h"
#include "scene/change_testing.h"
#include "scene/solid_rules.h"

namespace gpu_planning_scene::core
{
namespace
{
geometry_msgs::Pose poseMessage(double x, double y, double z, double qz = 0.0, double qw = 1.0)
{
  geometry_msgs::Pose pose;
  pose.position.x = x;
  pose.position.y = y;
  pose.position.z = z;
  pose.orientation.z = qz;
  pose.orientation.w = qw;
  return pose;
}

shape_msgs::SolidPrimitive primitive(std::uint8_t type, std::vector<double> dimensions)
{
  shape_msgs::SolidPrimitive message;
  message.type = type;
  message.dimensions = std::move(dimensions);
  return message;
}

shape_msgs::Mesh triangle()
{
  shape_msgs::Mesh mesh;
  mesh.vertices.resize(3);
  mesh.vertices[1].x = 1.0;
  mesh.vertices[2].y = 1.0;
  mesh.triangles.resize(1);
  mesh.triangles[0].vertex_indices = {{0, 1, 2}};
  return mesh;
}

CollisionObject box(const std::string& id)
{
  CollisionObject object;
  object.id = id;
  object.primitives = {primitive(shape_msgs::SolidPrimitive::BOX, {0.1, 0.2, 0.3})};
  return object;
}

PlanningSceneMessage diff()
{
  PlanningSceneMessage message;
  message.is_diff = true;
  message.robot_state.is_diff = true;
  return message;
}

class Messages : public SceneChanges
{
 protected:
  void applyMessage(const PlanningSceneMessage& message)
  {
    message_warnings_.clear();
    apply(changeFrom(message, *scene_.robot, limits_, &message_warnings_));
  }

  void applyObject(const CollisionObject& object)
  {
    PlanningSceneMessage message = diff();
    message.world.collision_objects = {object};
    applyMessage(message);
  }

  void refusedMessage(const std::string& fragment, const PlanningSceneMessage& message)
  {
    const PlanningScene before = scene_;
    const std::string error = errorOf([&] { applyMessage(message); });
    EXPECT_NE(std::string::npos, error.find(fragment)) << "'" << error << "' lacks '" << fragment << "'";
    expectSameScene(before, scene_);
  }

  void refusedObject(const std::string& fragment, const CollisionObject& object)
  {
    PlanningSceneMessage message = diff();
    message.world.collision_objects = {object};
    refusedMessage(fragment, message);
  }

  PlanningSceneMessage get(std::uint32_t components = 0) const
  {
    return messageOf(scene_, components, state_, std::vector<bool>(state_.size(), true));
  }

  std::vector<std::string> message_warnings_;
};

TEST_F(Messages, AnObjectHasAllThatItsMessageSays)
{
  CollisionObject object = box("a");
  object.header.frame_id = "rail";
  object.pose = poseMessage(1, 2, 3, 1.0, 1.0);  // the quaternion need not be normalised
  object.primitives.push_back(primitive(shape_msgs::SolidPrimitive::SPHERE, {0.5, 0.0, 0.0}));
  object.primitives.push_back(primitive(shape_msgs::SolidPrimitive::CYLINDER, {0.4, 0.1}));
  object.primitives.push_back(primitive(shape_msgs::SolidPrimitive::CONE, {0.6, 0.2}));
  object.primitive_poses = {poseMessage(0, 0, 7)};  // missing poses are the identity
  object.meshes = {triangle()};
  object.mesh_poses = {poseMessage(0, 0, 8)};
  object.planes.resize(1);
  object.planes[0].coef = {{0.0, 0.0, 2.0, -1.0}};
  object.subframe_names = {"tip"};
  object.subframe_poses = {poseMessage(0, 0, 9)};
  applyObject(object);
  const WorldObject& found = this->object("a");
  EXPECT_TRUE(found.pose.isApprox(poseAt(1, 2, 3, M_PI_2), 1e-15));
  ASSERT_EQ(6u, found.shapes.size());
  EXPECT_EQ(Eigen::Vector3d(0.1, 0.2, 0.3), std::get<Box>(found.shapes[0].shape).size);
  EXPECT_EQ(7.0, found.shapes[0].pose.translation().z());
  EXPECT_EQ(0.5, std::get<Sphere>(found.shapes[1].shape).radius);
  EXPECT_EQ(0.4, std::get<Cylinder>(found.shapes[2].shape).length);
  EXPECT_EQ(0.1, std::get<Cylinder>(found.shapes[2].shape).radius);
  EXPECT_EQ(0.6, std::get<Cone>(found.shapes[3].shape).length);
  EXPECT_EQ(3u, std::get<std::shared_ptr<const Mesh>>(found.shapes[4].shape)->vertices.size());
  EXPECT_EQ(8.0, found.shapes[4].pose.translation().z());
  EXPECT_EQ(Eigen::Vector3d::UnitZ(), std::get<HalfSpace>(found.shapes[5].shape).normal);
  EXPECT_EQ(0.5, std::get<HalfSpace>(found.shapes[5].shape).offset);
  EXPECT_EQ(9.0, found.subframes.at("tip").translation().z());
}

TEST_F(Messages, APoseOfAllZerosWasNeverSetAndAQuaternionOfZeroIsNoRotation)
{
  CollisionObject object = box("a");
  object.primitive_poses = {poseMessage(1, 0, 0)};
  applyObject(object);
  EXPECT_TRUE(this->object("a").pose.isApprox(poseAt(1, 0, 0))) << "the lone shape's pose";
  object.pose = poseMessage(0, 5, 0, 0.0, 0.0);
  applyObject(object);
  EXPECT_TRUE(this->object("a").pose.isApprox(poseAt(0, 5, 0)));
  EXPECT_TRUE(this->object("a").shapes[0].pose.isApprox(poseAt(1, 0, 0)));
}

TEST_F(Messages, FramesAreRequestedAtTheirStamp)
{
  CollisionObject object = box("a");
  object.header.frame_id = "camera";
  object.header.stamp = ros::Time(12, 34);
  const StampedFrame frame = objectChangeFrom(object).frame;
  EXPECT_EQ("camera", frame.name);
  EXPECT_EQ(12000000034, frame.stamp);
}

TEST_F(Messages, AMoveTakesThePosesOfAllShapesInTheirOrder)
{
  CollisionObject object = box("a");
  object.meshes = {triangle()};
  applyObject(object);
  CollisionObject move;
  move.id = "a";
  move.operation = CollisionObject::MOVE;
  move.pose = poseMessage(1, 0, 0);
  move.primitive_poses = {poseMessage(0, 0, 1)};
  move.mesh_poses = {poseMessage(0, 0, 2)};
  applyObject(move);
  EXPECT_EQ(1.0, this->object("a").shapes[0].pose.translation().z());
  EXPECT_EQ(2.0, this->object("a").shapes[1].pose.translation().z());
  move.primitives = object.primitives;
  move.mesh_poses.clear();
  refusedObject("leave the shapes out", move);
}

TEST_F(Messages, EqualMeshesOfOneMessageAreOneMesh)
{
  CollisionObject object;
  object.meshes = {triangle(), triangle()};
  PlanningSceneMessage message = diff();
  for (const char* id : {"a", "b"})
  {
    object.id = id;
    message.world.collision_objects.push_back(object);
  }
  applyMessage(message);
  const auto mesh = [&](const char* id, std::size_t i)
  { return std::get<std::shared_ptr<const Mesh>>(this->object(id).shapes.at(i).shape); };
  EXPECT_EQ(mesh("a", 0), mesh("a", 1));
  EXPECT_EQ(mesh("a", 0), mesh("b", 0));
}

TEST_F(Messages, JointsAreSetByName)
{
  PlanningSceneMessage message = diff();
  message.robot_state.joint_state.name = {"turn", "gripper", "flag", "bolt"};
  message.robot_state.joint_state.position = {0.25, 1.0, 2.0, 3.0};
  applyMessage(message);
  EXPECT_EQ((std::vector<double>{0.5, 0.25}), state_);
  const std::string warnings_text = ::testing::PrintToString(message_warnings_);
  EXPECT_NE(std::string::npos, warnings_text.find("does not have them: gripper")) << warnings_text;
  EXPECT_NE(std::string::npos, warnings_text.find("follow other joints: flag")) << warnings_text;
  EXPECT_NE(std::string::npos, warnings_text.find("fixed: bolt")) << warnings_text;
  message.robot_state.joint_state.position.pop_back();
  refusedMessage("3 values for 4 names", message);
  message.robot_state.joint_state.name = {"turn", "turn"};
  message.robot_state.joint_state.position = {0.0, 0.0};
  refusedMessage("given twice", message);
}

TEST_F(Messages, JointsWithSeveralVariablesTakeTransforms)
{
  for (const char* type : {"planar", "floating"})
  {
    scene_ = PlanningScene(sliderRobotOnFloor(type));
    state_ = scene_.robot->defaultState();
    PlanningSceneMessage message = diff();
    sensor_msgs::MultiDOFJointState& joints = message.robot_state.multi_dof_joint_state;
    joints.header.frame_id = "hall";
    joints.joint_names = {"floor"};
    joints.transforms.resize(1);
    joints.transforms[0].translation.x = 3.0;
    joints.transforms[0].rotation.z = joints.transforms[0].rotation.w = 1.0;
    applyMessage(message);
    EXPECT_TRUE(scene_.frame("rail", state_.data())->isApprox(poseAt(3, 0, 0, M_PI_2), 1e-15));
    EXPECT_EQ("floor", get().robot_state.multi_dof_joint_state.joint_names.at(0));
    joints.header.frame_id = "camera";
    refusedMessage("must be the planning frame 'hall'", message);
    joints.header.frame_id = "";
    joints.joint_names = {"turn"};
    refusedMessage("neither planar nor floating", message);
  }
}

TEST_F(Messages, TransformsAreMotionsFromTheOriginOfTheJoint)
{
  using Eigen::AngleAxisd;
  using Eigen::Translation3d;
  using Eigen::Vector3d;
  for (const char* type : {"planar", "floating"})
  {
    SCOPED_TRACE(type);
    scene_ = PlanningScene(
        robotOf(boxLink("base") + boxLink("arm") + boxLink("body") +
                jointXml("lift", "prismatic", "base", "arm",
                         "<origin xyz='0 0 1' rpy='0 0 0.5'/><axis xyz='0 0 1'/>" + std::string(kLimits)) +
                jointXml("free", type, "arm", "body", "<origin xyz='1 0 0' rpy='0 0 1.2'/><axis xyz='0 0 1'/>")));
    state_ = scene_.robot->defaultState();
    PlanningSceneMessage message = diff();
    message.robot_state.joint_state.name = {"lift"};
    message.robot_state.joint_state.position = {0.25};
    sensor_msgs::MultiDOFJointState& joints = message.robot_state.multi_dof_joint_state;
    joints.joint_names = {"free"};
    joints.transforms.resize(1);
    joints.transforms[0].translation.x = 3.0;
    joints.transforms[0].translation.y = -2.0;
    joints.transforms[0].rotation.z = std::sin(0.35);
    joints.transforms[0].rotation.w = std::cos(0.35);
    const Eigen::Isometry3d motion = Translation3d(3.0, -2.0, 0.0) * AngleAxisd(0.7, Vector3d::UnitZ());
    const Eigen::Isometry3d expected = Translation3d(0.0, 0.0, 1.25) * AngleAxisd(0.5, Vector3d::UnitZ()) *
                                       Translation3d(1.0, 0.0, 0.0) * AngleAxisd(1.2, Vector3d::UnitZ()) * motion;
    for (const char* frame : {"", "base", "/base"})
    {
      joints.header.frame_id = frame;
      applyMessage(message);
      EXPECT_TRUE(scene_.frame("body", state_.data())->isApprox(expected, 1e-12)) << frame;
    }
    // What the node gives back is what it has been given.
    const sensor_msgs::MultiDOFJointState given_back = get().robot_state.multi_dof_joint_state;
    EXPECT_EQ("base", given_back.header.frame_id);
    EXPECT_NEAR(3.0, given_back.transforms.at(0).translation.x, 1e-12);
    EXPECT_NEAR(-2.0, given_back.transforms.at(0).translation.y, 1e-12);
    EXPECT_NEAR(std::sin(0.35), given_back.transforms.at(0).rotation.z, 1e-12);
    joints.header.frame_id = "arm";
    refusedMessage("is given in frame 'arm'; it must be the planning frame 'base' or empty", message);
  }
}

TEST_F(Messages, ALinkThatIsFixedInThePlanningFrameIsAFrameOfTransformsOnlyWithoutAnOffset)
{
  const std::string links = boxLink("base") + boxLink("deck") + boxLink("mast") + boxLink("body") +
                            jointXml("bolt", "fixed", "base", "deck") +
                            jointXml("pole", "fixed", "base", "mast", "<origin xyz='0 0 1'/>") +
                            jointXml("free", "floating", "deck", "body");
  scene_ = PlanningScene(
      robotOf(links, "<virtual_joint name='stand' type='fixed' parent_frame='world' child_link='base'/>"));
  state_ = scene_.robot->defaultState();
  PlanningSceneMessage message = diff();
  sensor_msgs::MultiDOFJointState& joints = message.robot_state.multi_dof_joint_state;
  joints.joint_names = {"free"};
  joints.transforms.resize(1);
  joints.transforms[0].translation.x = 3.0;
  joints.transforms[0].rotation.w = 1.0;
  for (const char* frame : {"world", "base", "deck"})
  {
    joints.header.frame_id = frame;
    applyMessage(message);
    EXPECT_TRUE(scene_.frame("body", state_.data())->isApprox(poseAt(3, 0, 0), 1e-15)) << frame;
  }
  for (const char* frame : {"mast", "body", "nowhere"})
  {
    joints.header.frame_id = frame;
    refusedMessage("it must be the planning frame 'world' or empty", message);
  }
}

TEST_F(Messages, AttachedObjectsFollowMoveItsRulesOfIsDiff)
{
  PlanningSceneMessage attach = diff();
  attach.robot_state.attached_collision_objects.resize(1);
  AttachedCollisionObject& attached = attach.robot_state.attached_collision_objects[0];
  attached.link_name = "pole";
  attached.object = box("a");
  attached.touch_links = {"cart"};
  applyMessage(attach);
  EXPECT_EQ(1u, carried("a").touch_links.size());
  applyMessage(diff());
  EXPECT_EQ(1u, scene_.attached.size()) << "an empty state changes nothing";
  PlanningSceneMessage trap = diff();
  trap.robot_state.is_diff = false;
  applyMessage(trap);
  EXPECT_EQ(1u, scene_.attached.size()) << "without joint values too";
  trap.robot_state.joint_state.name = {"turn"};
  trap.robot_state.joint_state.position = {0.0};
  applyMessage(trap);
  EXPECT_TRUE(scene_.attached.empty());
  EXPECT_TRUE(warned("object 'a' was removed"));
}

TEST_F(Messages, AMatrixIsTakenAsItIsWrittenAndAnEmptyOneIsNone)
{
  PlanningSceneMessage message = diff();
  applyMessage(message);
  EXPECT_TRUE(scene_.allowed_collisions.allowed("cart", "pole"));
  AllowedCollisionMatrixMessage& matrix = message.allowed_collision_matrix;
  matrix.entry_names = {"cart", "nut"};
  matrix.entry_values.resize(2);
  matrix.entry_values[0].enabled = {0, 1};
  matrix.entry_values[1].enabled = {1, 0};
  matrix.default_entry_names = {"lamp"};
  matrix.default_entry_values = {1};
  applyMessage(message);
  EXPECT_FALSE(scene_.allowed_collisions.allowed("cart", "pole"));
  EXPECT_TRUE(scene_.allowed_collisions.allowed("nut", "cart"));
  EXPECT_TRUE(scene_.allowed_collisions.allowed("lamp", "drum"));
  matrix.entry_values[1].enabled = {0, 0};
  refusedMessage("not symmetric", message);
  matrix.entry_values[1].enabled = {0};
  refusedMessage("1 values for 2 names", message);
  matrix.entry_values.pop_back();
  refusedMessage("1 values for 2 names", message);
  matrix.entry_names = {"cart", "cart"};
  matrix.entry_values.assign(2, matrix.entry_values[0]);
  refusedMessage("twice", message);
  matrix = AllowedCollisionMatrixMessage();
  matrix.default_entry_values = {1};
  refusedMessage("1 values for 0 names", message);
}

TEST_F(Messages, AMatrixOfDefaultsAloneChangesNothingInADifference)
{
  PlanningSceneMessage message = diff();
  message.allowed_collision_matrix.default_entry_names = {"lamp"};
  message.allowed_collision_matrix.default_entry_values = {1};
  applyMessage(message);
  EXPECT_TRUE(scene_.allowed_collisions == AllowedCollisionMatrix::fromRobot(*scene_.robot));
  ASSERT_EQ(1u, message_warnings_.size());
  EXPECT_NE(std::string::npos, message_warnings_[0].find("ignored: a difference with only default entries"));
  message.is_diff = false;
  applyMessage(message);
  EXPECT_TRUE(scene_.allowed_collisions.allowed("lamp", "drum")) << "a full scene has no matrix before it";
  const PlanningSceneMessage whole = get();
  EXPECT_FALSE(whole.allowed_collision_matrix.entry_names.empty());
  message = whole;
  message.is_diff = true;
  message.robot_state.is_diff = true;
  message.robot_state.attached_collision_objects.clear();
  scene_ = PlanningScene(sliderRobot());
  applyMessage(message);
  EXPECT_TRUE(scene_.allowed_collisions.allowed("lamp", "drum")) << "what the node itself says can be sent back";
}

TEST_F(Messages, AMatrixIsHeldAgainstTheLimitsBeforeItIsRead)
{
  AllowedCollisionMatrixMessage matrix;
  matrix.entry_names = {"a", "b", "c"};  // without rows, which would be an error if the matrix were read
  SceneLimits some;
  const auto refusal = [&] { return errorOf([&] { matrixFrom(matrix, some); }); };
  const auto refused_for = [&](const char* parameter) { return refusal().find(parameter) != std::string::npos; };
  some.matrix_entries = 9;
  EXPECT_FALSE(refused_for("limits/matrix_entries"));
  some.matrix_entries = 8;
  EXPECT_TRUE(refused_for("limits/matrix_entries")) << refusal();
  some.matrix_entries = 10;
  matrix.entry_names[1] = std::string(64, 'b');
  EXPECT_TRUE(refused_for("limits/matrix_entries")) << "a long name in each row: " << refusal();
  some.matrix_entries = 12;
  EXPECT_FALSE(refused_for("limits/matrix_entries")) << refusal();
  matrix.default_entry_names = {"d"};
  EXPECT_TRUE(refused_for("limits/matrix_entries")) << refusal();
  some.matrix_entries = 0;
  EXPECT_FALSE(refused_for("limits/")) << "no limit";
  some.name_length = 63;
  EXPECT_TRUE(refused_for("limits/name_length")) << refusal();
  matrix.entry_names[1] = "b";
  EXPECT_FALSE(refused_for("limits/")) << refusal();
  matrix.default_entry_names[0] = std::string(64, 'd');
  EXPECT_TRUE(refused_for("limits/name_length")) << refusal();

  PlanningSceneMessage message = diff();
  message.allowed_collision_matrix = matrix;
  limits_ = some;
  refusedMessage("limits/name_length", message);
}

TEST_F(Messages, AMatrixThatAllowsNothingComesBackAsOne)
{
  PlanningSceneMessage message = diff();
  message.allowed_collision_matrix.entry_names = {"cart"};
  message.allowed_collision_matrix.entry_values.resize(1);
  message.allowed_collision_matrix.entry_values[0].enabled = {0};
  applyMessage(message);
  EXPECT_FALSE(scene_.allowed_collisions.allowed("cart", "pole"));
  const PlanningSceneMessage whole = get();
  scene_ = PlanningScene(sliderRobot());
  EXPECT_TRUE(scene_.allowed_collisions.allowed("cart", "pole"));
  applyMessage(whole);
  EXPECT_FALSE(scene_.allowed_collisions.allowed("cart", "pole")) << "an empty matrix would be the SRDF's";
}

TEST_F(Messages, InvalidMessagesAreRefused)
{
  CollisionObject object = box("a");
  object.operation = 4;
  refusedObject("unknown operation 4", object);
  object = box("a");
  object.primitive_poses.resize(2);
  refusedObject("2 primitive_poses for 1", object);
  object = box("a");
  object.primitives[0].dimensions = {1.0};
  refusedObject("primitive 0: expected the dimensions [x, y, z], found 1", object);
  object.primitives[0].type = 9;
  refusedObject("unknown primitive type 9", object);
  object = box("a");
  object.planes.resize(1);
  refusedObject("plane 0: the plane", object);
  object = box("a");
  object.subframe_names = {"tip"};
  refusedObject("0 subframe_poses for 1", object);
  object.subframe_names = {"tip", "tip"};
  object.subframe_poses.resize(2);
  refusedObject("subframe 'tip' is given twice", object);
  object = box("a");
  object.meshes = {triangle()};
  object.meshes[0].triangles[0].vertex_indices = {{0, 1, 3}};
  refusedObject("names vertex 3", object);
  object = box("a");
  object.pose = poseMessage(std::nan(""), 0, 0);
  refusedObject("not finite", object);
  PlanningSceneMessage message = diff();
  message.link_padding.resize(2);
  message.link_padding[0].link_name = message.link_padding[1].link_name = "cart";
  refusedMessage("the padding of 'cart' is given twice", message);
  message = diff();
  message.fixed_frame_transforms.resize(1);
  message.fixed_frame_transforms[0].header.frame_id = "pole";
  refusedMessage("must be the planning frame 'rail'", message);
}

/// MoveIt writes the planning frame as child_frame_id, and tf as frame_id.
TEST_F(Messages, FixedFramesCanBeNamedAsMoveItDoesAndAsTfDoes)
{
  for (const bool as_moveit : {true, false})
  {
    PlanningSceneMessage message = diff();
    message.fixed_frame_transforms.resize(2);
    geometry_msgs::TransformStamped& frame = message.fixed_frame_transforms[0];
    frame.header.frame_id = as_moveit ? "map" : "rail";
    frame.child_frame_id = as_moveit ? "/rail" : "map";
    frame.transform.translation.z = 2.0;
    frame.transform.rotation.w = 1.0;
    geometry_msgs::TransformStamped& own = message.fixed_frame_transforms[1];
    own.header.frame_id = own.child_frame_id = "rail";
    own.transform.rotation.w = 1.0;
    const SceneChange change = changeFrom(message, *scene_.robot, limits_, nullptr);
    ASSERT_EQ(1U, change.fixed_frames.count("map"));
    EXPECT_EQ(2.0, change.fixed_frames.at("map").translation().z());
    EXPECT_EQ(1U, change.fixed_frames.count("rail"));
  }
}

/// A scene with every kind of content.
PlanningSceneMessage everything()
{
  PlanningSceneMessage message;
  message.name = "workshop";
  message.robot_model_name = "slider";
  message.robot_state.joint_state.name = {"slide", "turn"};
  message.robot_state.joint_state.position = {0.25, -1.5};
  message.robot_state.attached_collision_objects.resize(1);
  AttachedCollisionObject& attached = message.robot_state.attached_collision_objects[0];
  attached.link_name = "pole";
  attached.object = box("tool");
  attached.object.header.frame_id = "cart";
  attached.object.pose = poseMessage(0.3, 0.2, 0.1, 0.5, 0.7);
  attached.touch_links = {"cart"};
  message.fixed_frame_transforms.resize(1);
  message.fixed_frame_transforms[0].child_frame_id = "camera";
  message.fixed_frame_transforms[0].transform.translation.z = 2.0;
  message.allowed_collision_matrix.entry_names = {"cart", "table"};
  message.allowed_collision_matrix.entry_values.resize(2);
  message.allowed_collision_matrix.entry_values[0].enabled = {0, 1};
  message.allowed_collision_matrix.entry_values[1].enabled = {1, 0};
  message.link_padding.resize(1);
  message.link_padding[0].link_name = "cart";
  message.link_padding[0].padding = 0.02;
  message.link_scale.resize(1);
  message.link_scale[0].link_name = "pole";
  message.link_scale[0].scale = 1.5;
  message.object_colors.resize(1);
  message.object_colors[0].id = "table";
  message.object_colors[0].color.r = 0.5F;
  CollisionObject table = box("table");
  table.header.frame_id = "camera";
  table.meshes = {triangle()};
  table.planes.resize(1);
  table.planes[0].coef = {{0.0, 0.6, 0.8, 0.25}};
  table.subframe_names = {"corner"};
  table.subframe_poses = {poseMessage(1, 1, 0)};
  message.world.collision_objects = {table};
  message.solids.resize(1);
  message.solids[0].id = "table";
  message.solids[0].solid = BodySolid::FILLED;
  return message;
}

TEST_F(Messages, TheMessageOfASceneMakesItAgain)
{
  applyMessage(everything());
  const PlanningScene first = scene_;
  const PlanningSceneMessage message = get();
  EXPECT_FALSE(message.is_diff);
  scene_ = PlanningScene(sliderRobot());
  state_.clear();
  applyMessage(message);
  expectSameScene(first, scene_, 1e-14);
}

TEST_F(Messages, OnlyTheRequestedComponentsAreThere)
{
  using Components = PlanningSceneComponents;
  applyMessage(everything());
  PlanningSceneMessage message = get(Components::SCENE_SETTINGS);
  EXPECT_EQ("workshop", message.name);
  EXPECT_EQ("slider", message.robot_model_name);
  EXPECT_TRUE(message.world.collision_objects.empty());
  message = get(Components::ROBOT_STATE);
  EXPECT_EQ("", message.name);
  EXPECT_EQ(2u, message.robot_state.joint_state.name.size());
  EXPECT_TRUE(message.robot_state.attached_collision_objects.empty());
  message = get(Components::ROBOT_STATE_ATTACHED_OBJECTS);
  EXPECT_TRUE(message.robot_state.joint_state.name.empty());
  ASSERT_EQ(1u, message.robot_state.attached_collision_objects.size());
  EXPECT_EQ(1u, message.robot_state.attached_collision_objects[0].object.primitives.size());
  message = get(Components::WORLD_OBJECT_NAMES);
  ASSERT_EQ(1u, message.world.collision_objects.size());
  EXPECT_EQ("table", message.world.collision_objects[0].id);
  EXPECT_TRUE(message.world.collision_objects[0].primitives.empty());
  message = get(Components::WORLD_OBJECT_GEOMETRY);
  EXPECT_EQ(1u, message.world.collision_objects.at(0).primitives.size());
  EXPECT_EQ(1u, message.world.collision_objects.at(0).subframe_names.size());
  EXPECT_EQ(BodySolid::FILLED, message.solids.at(0).solid);
  message = get(Components::TRANSFORMS);
  EXPECT_EQ("camera", message.fixed_frame_transforms.at(0).header.frame_id);
  EXPECT_EQ("rail", message.fixed_frame_transforms.at(0).child_frame_id);
  message = get(Components::ALLOWED_COLLISION_MATRIX);
  EXPECT_EQ(2u, message.allowed_collision_matrix.entry_names.size());
  message = get(Components::LINK_PADDING_AND_SCALING);
  ASSERT_EQ(2u, message.link_padding.size()) << "the links with shapes";
  EXPECT_EQ(2u, message.link_scale.size());
  message = get(Components::LINK_PADDING_AND_SCALING | kForFollowers);
  ASSERT_EQ(scene_.robot->links().size(), message.link_padding.size())
      << "also links without shapes, which may carry objects";
  EXPECT_EQ(scene_.robot->links().size(), message.link_scale.size());
  message = get(Components::OBJECT_COLORS);
  EXPECT_EQ(0.5F, message.object_colors.at(0).color.r);
  message = get(Components::OCTOMAP);
  EXPECT_TRUE(message.name.empty() && message.world.collision_objects.empty() && message.object_colors.empty());
}

TEST_F(Messages, RulesForSolidsGoThroughTheirMessages)
{
  scene_ = PlanningScene(sliderRobotOfMeshes());
  applyMessage(everything());
  const PlanningScene first = scene_;
  PlanningSceneMessage rules = diff();
  rules.solids.resize(2);
  rules.solids[0].id = "cart";
  rules.solids[0].solid = BodySolid::SURFACE;
  rules.solids[1].id = "table";
  rules.solids[1].solid = BodySolid::AUTO;
  applyMessage(rules);
  const PlanningScene second = scene_;
  EXPECT_EQ((std::map<std::string, SolidRule>{{"cart", SolidRule::Surface}, {"pole", SolidRule::Auto}}),
            solidRulesOf(second));
  const PlanningSceneMessage whole = get();
  for (const auto& [from, to] : {std::pair(first, second), {second, first}})
  {
    scene_ = from;
    const PlanningSceneMessage way = messageOf(diffOf(from, to), *from.robot);
    EXPECT_TRUE(way.is_diff);
    applyMessage(way);
    expectSameScene(to, scene_, 1e-14);
  }
  applyMessage(whole);
  expectSameScene(second, scene_, 1e-14);

  rules.solids[1].id = "cart";
  refusedMessage("the solid of 'cart' is given twice", rules);
  rules.solids.resize(1);
  rules.solids[0].solid = 3;
  refusedMessage("solids: the rule of 'cart' is 3", rules);
}

TEST_F(Messages, JointsThatAreNotKnownAreLeftOut)
{
  const PlanningSceneMessage message = messageOf(scene_, 0, {0.5, 0.0}, {true, false});
  EXPECT_EQ((std::vector<std::string>{"slide"}), message.robot_state.joint_state.name);
}

TEST_F(Messages, ADifferenceBetweenScenesGoesThroughItsMessage)
{
  const PlanningScene first = scene_;
  const std::vector<double> first_state = state_;
  applyMessage(everything());
  const PlanningScene second = scene_;
  applyObject(box("bin"));
  change(attachedChange(Operation::Remove, "tool", ""));
  ObjectChange move = objectChange(Operation::Move, "table");
  move.pose = poseAt(1, 2, 3, 0.25);
  change(move);
  const PlanningScene third = scene_;

  scene_ = first;
  state_ = first_state;
  applyMessage(messageOf(diffOf(first, second), *scene_.robot));
  expectSameScene(second, scene_, 1e-14);
  const SceneChange to_third = diffOf(second, third);
  EXPECT_TRUE(to_third.is_diff);
  applyMessage(messageOf(to_third, *scene_.robot));
  expectSameScene(third, scene_, 1e-14);
}
}  // namespace
}  // namespace gpu_planning_scene::core
