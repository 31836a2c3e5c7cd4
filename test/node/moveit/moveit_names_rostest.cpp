// A node with the names of a move_group, and clients that know only MoveIt's types.

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <moveit/planning_scene/planning_scene.h>
#include <moveit_msgs/ApplyPlanningScene.h>
#include <moveit_msgs/GetPlanningScene.h>
#include <moveit_msgs/GetStateValidity.h>
#include <moveit_msgs/PlanningSceneWorld.h>
#include <roscpp/Empty.h>
#include <rosgraph_msgs/Log.h>

#include "gpu_planning_scene/octomap.h"
#include "node/child_node.h"
#include "node/moveit/move_group.h"
#include "node/moveit/moveit_client.h"
#include "node/moveit/moveit_messages.h"
#include "node/persistent_call.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kLongest = 10.0;  // seconds: longest wait for the node

class MoveItNames : public testing::Test
{
 public:
  static void SetUpTestSuite()
  {
    model = moveItPanda();
    node = std::make_unique<ChildNode>("named", std::vector<std::string>{"_device:=cpu", "_moveit_names:=true"});
  }
  static void TearDownTestSuite()
  {
    node.reset();
    model.reset();
  }

  /// An empty world, and the robot in a free state.
  void SetUp() override
  {
    moveit::core::RobotState state(model);
    state.setToDefaultValues();
    state.setToDefaultValues(model->getJointModelGroup("panda_arm"), "ready");
    moveit_msgs::PlanningScene start;
    planning_scene::PlanningScene empty(model);
    empty.setCurrentState(state);
    empty.getPlanningSceneMsg(start);
    ASSERT_TRUE(apply(start));
  }

  static bool apply(const moveit_msgs::PlanningScene& scene)
  {
    moveit_msgs::ApplyPlanningScene call;
    call.request.scene = scene;
    EXPECT_TRUE(callPersistently("/apply_planning_scene", call));
    return call.response.success;
  }

  static moveit_msgs::PlanningScene get(std::uint32_t components = 0)
  {
    moveit_msgs::GetPlanningScene call;
    call.request.components.components = components;
    EXPECT_TRUE(callPersistently("/get_planning_scene", call));
    return call.response.scene;
  }

  static moveit_msgs::PlanningScene diff()
  {
    moveit_msgs::PlanningScene scene;
    scene.is_diff = true;
    scene.robot_state.is_diff = true;
    return scene;
  }

  static moveit_msgs::AttachedCollisionObject carriedBox(double size)
  {
    moveit_msgs::AttachedCollisionObject attached;
    attached.link_name = "panda_hand";
    attached.touch_links = {"panda_hand", "panda_leftfinger", "panda_rightfinger"};
    attached.object = moveItBox("carried", 0.0, size);
    attached.object.header.frame_id = "panda_hand";
    attached.object.pose.position.z = 0.15;
    return attached;
  }

  /// The answer for the current state with the changes of the request; no value if the call fails.
  static std::optional<moveit_msgs::GetStateValidity::Response> validity(
      const moveit_msgs::GetStateValidity::Request& request, const std::string& service = "/check_state_validity")
  {
    moveit_msgs::GetStateValidity call;
    call.request = request;
    if (!callPersistently(service, call))
      return std::nullopt;
    return call.response;
  }

  /// Where the hand of the ready state is.
  static Eigen::Vector3d hand()
  {
    moveit::core::RobotState state(model);
    state.setToDefaultValues();
    state.setToDefaultValues(model->getJointModelGroup("panda_arm"), "ready");
    state.update();
    return state.getGlobalLinkTransform("panda_hand").translation();
  }

  static moveit_msgs::CollisionObject boxAtHand(double size)
  {
    moveit_msgs::CollisionObject object = moveItBox("box", hand().x(), size);
    object.pose.position.y = hand().y();
    object.pose.position.z = hand().z();
    return object;
  }

  template <class Wanted>
  static bool waitFor(const Wanted& wanted)
  {
    for (const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kLongest); ros::WallTime::now() < end;)
    {
      if (wanted())
        return true;
      ros::WallDuration(0.05).sleep();
    }
    return false;
  }

  template <class Message>
  static ros::Publisher publisherOf(const std::string& topic)
  {
    ros::Publisher publisher = ros::NodeHandle().advertise<Message>(topic, 100);
    EXPECT_TRUE(waitFor([&publisher] { return publisher.getNumSubscribers() != 0; })) << topic;
    return publisher;
  }

  static std::set<std::string> objects()
  {
    std::set<std::string> ids;
    for (const auto& object : get().world.collision_objects)
      ids.insert(object.id);
    return ids;
  }

  static moveit::core::RobotModelPtr model;
  static std::unique_ptr<ChildNode> node;
};
moveit::core::RobotModelPtr MoveItNames::model;
std::unique_ptr<ChildNode> MoveItNames::node;

TEST_F(MoveItNames, AScenesOfRandomChangesComeBackAsMoveItHasThem)
{
  RandomChanges change(7);
  planning_scene::PlanningScene scene(model);
  scene.getCurrentStateNonConst().setToDefaultValues();
  for (int i = 0; i < 20; ++i)
  {
    for (int k = 0; k < 10; ++k)
      change(scene);
    moveit_msgs::PlanningScene message;
    scene.getPlanningSceneMsg(message);
    ASSERT_TRUE(apply(message));
    const moveit_msgs::PlanningScene answer = get();
    ASSERT_EQ("", differenceOf(message, answer));
    // MoveIt reads the answer as the same scene.
    planning_scene::PlanningScene read(model);
    ASSERT_TRUE(read.setPlanningSceneMsg(answer));
    moveit_msgs::PlanningScene again;
    read.getPlanningSceneMsg(again);
    ASSERT_EQ("", differenceOf(message, again));
    // The answer leaves out joints that follow other joints; MoveIt fills them in.
    EXPECT_EQ(message.robot_state.joint_state.position, again.robot_state.joint_state.position);
  }
}

TEST_F(MoveItNames, EveryFieldComesBack)
{
  moveit_msgs::PlanningScene scene = diff();
  scene.name = "a scene";
  scene.robot_state.joint_state.name = {"panda_joint1"};
  scene.robot_state.joint_state.position = {0.5};
  geometry_msgs::TransformStamped frame;
  frame.header.frame_id = "map";
  frame.child_frame_id = "world";
  frame.transform.translation.x = 3.0;
  frame.transform.rotation.w = 1.0;
  scene.fixed_frame_transforms.push_back(frame);
  scene.link_padding.resize(1);
  scene.link_padding[0].link_name = "panda_hand";
  scene.link_padding[0].padding = 0.01;
  scene.link_scale.resize(1);
  scene.link_scale[0].link_name = "panda_link5";
  scene.link_scale[0].scale = 1.1;
  scene.object_colors.resize(1);
  scene.object_colors[0].id = "box";
  scene.object_colors[0].color.g = 0.5F;
  scene.allowed_collision_matrix = get().allowed_collision_matrix;
  scene.allowed_collision_matrix.default_entry_names = {"box"};
  scene.allowed_collision_matrix.default_entry_values = {1};
  moveit_msgs::CollisionObject box = moveItBox("box", 2.0, 0.1);
  box.type.key = "key";
  box.type.db = "db";
  box.subframe_names = {"corner"};
  box.subframe_poses.resize(1);
  box.subframe_poses[0].position.x = 0.05;
  box.subframe_poses[0].orientation.w = 1.0;
  shape_msgs::Plane plane;
  plane.coef = {{0.0, 0.0, 1.0, 5.0}};
  box.planes.push_back(plane);
  box.plane_poses.push_back(box.primitive_poses[0]);
  scene.world.collision_objects.push_back(box);
  moveit_msgs::AttachedCollisionObject carried = carriedBox(0.05);
  carried.weight = 1.5;
  carried.detach_posture.joint_names = {"panda_finger_joint1"};
  carried.detach_posture.points.resize(1);
  carried.detach_posture.points[0].positions = {0.04};
  scene.robot_state.attached_collision_objects.push_back(carried);
  ASSERT_TRUE(apply(scene));

  const moveit_msgs::PlanningScene answer = get();
  EXPECT_EQ("a scene", answer.name);
  EXPECT_EQ("panda", answer.robot_model_name);
  ASSERT_EQ(1U, answer.fixed_frame_transforms.size());
  EXPECT_EQ("map", answer.fixed_frame_transforms[0].header.frame_id);
  EXPECT_EQ("world", answer.fixed_frame_transforms[0].child_frame_id);
  EXPECT_EQ(3.0, answer.fixed_frame_transforms[0].transform.translation.x);
  ASSERT_EQ(1U, answer.object_colors.size());
  EXPECT_EQ(0.5F, answer.object_colors[0].color.g);
  EXPECT_EQ(std::vector<std::string>{"box"}, answer.allowed_collision_matrix.default_entry_names);
  moveit_msgs::PlanningScene wanted = answer;
  wanted.world.collision_objects = {box};
  wanted.robot_state.attached_collision_objects = {carried};
  EXPECT_EQ("", differenceOf(wanted, answer));
  EXPECT_EQ(1.5, answer.robot_state.attached_collision_objects.at(0).weight);
  EXPECT_EQ(carried.detach_posture.joint_names,
            answer.robot_state.attached_collision_objects.at(0).detach_posture.joint_names);
  const auto padding_of = [&answer](const std::string& link)
  {
    for (const auto& padding : answer.link_padding)
      if (padding.link_name == link)
        return padding.padding;
    return -1.0;
  };
  EXPECT_EQ(0.01, padding_of("panda_hand"));
  EXPECT_EQ(0.0, padding_of("panda_link5"));
  EXPECT_EQ(0.5, answer.robot_state.joint_state.position.at(0));
}

TEST_F(MoveItNames, AWrongSceneChangesNothing)
{
  moveit_msgs::PlanningScene scene = diff();
  scene.world.collision_objects = {moveItBox("good", 1.0, 0.1), moveItBox("bad", 1.0, -0.1)};
  EXPECT_FALSE(apply(scene));
  EXPECT_TRUE(objects().empty());
}

TEST_F(MoveItNames, AJointAwayFromTheJointThatItFollowsIsReported)
{
  std::mutex mutex;
  std::string warnings;
  const ros::Subscriber log = ros::NodeHandle().subscribe<rosgraph_msgs::Log>(
      "/rosout", 1000,
      boost::function<void(const rosgraph_msgs::LogConstPtr&)>(
          [&](const rosgraph_msgs::LogConstPtr& message)
          {
            const std::lock_guard<std::mutex> lock(mutex);
            if (message->level == rosgraph_msgs::Log::WARN && message->name == "/named")
              warnings += message->msg;
          }));
  ASSERT_TRUE(waitFor([&log] { return log.getNumPublishers() > 1; }));
  ros::WallDuration(0.5).sleep();  // the node sends its log to this program now
  moveit_msgs::PlanningScene scene = diff();
  scene.robot_state.joint_state.name = {"panda_finger_joint1", "panda_finger_joint2"};
  scene.robot_state.joint_state.position = {0.01, 0.04};
  ASSERT_TRUE(apply(scene));
  const auto is_reported = [&]
  {
    const std::lock_guard<std::mutex> lock(mutex);
    return warnings.find("'panda_finger_joint2' follows 'panda_finger_joint1'") != std::string::npos;
  };
  EXPECT_TRUE(waitFor(is_reported));
}

TEST_F(MoveItNames, ChangesComeByMoveItsTopics)
{
  const ros::Publisher object = publisherOf<moveit_msgs::CollisionObject>("/collision_object");
  object.publish(moveItBox("first", 1.0, 0.1));
  EXPECT_TRUE(waitFor([] { return objects() == std::set<std::string>{"first"}; }));
  moveit_msgs::PlanningScene scene = diff();
  scene.world.collision_objects = {moveItBox("second", 1.5, 0.1)};
  const ros::Publisher scenes = publisherOf<moveit_msgs::PlanningScene>("/planning_scene");
  scenes.publish(scene);
  EXPECT_TRUE(waitFor([] { return objects() == std::set<std::string>{"first", "second"}; }));
  const ros::Publisher attached = publisherOf<moveit_msgs::AttachedCollisionObject>("/attached_collision_object");
  attached.publish(carriedBox(0.05));
  EXPECT_TRUE(waitFor([] { return get().robot_state.attached_collision_objects.size() == 1; }));
}

TEST_F(MoveItNames, AWorldReplacesAllObjectsAndKeepsTheMatrix)
{
  moveit_msgs::PlanningScene scene = diff();
  scene.world.collision_objects = {moveItBox("stays", 1.0, 0.1), moveItBox("goes", 2.0, 0.1)};
  ASSERT_TRUE(apply(scene));
  planning_scene::PlanningScene matrix(model);
  matrix.getAllowedCollisionMatrixNonConst().setEntry("stays", "panda_hand", true);
  scene = diff();
  matrix.getAllowedCollisionMatrix().getMessage(scene.allowed_collision_matrix);
  ASSERT_TRUE(apply(scene));
  moveit_msgs::PlanningSceneWorld world;
  world.collision_objects = {moveItBox("stays", 3.0, 0.1), moveItBox("comes", 2.0, 0.1)};
  const ros::Publisher worlds = publisherOf<moveit_msgs::PlanningSceneWorld>("/planning_scene_world");
  worlds.publish(world);
  EXPECT_TRUE(waitFor([] { return objects() == std::set<std::string>{"stays", "comes"}; }));
  planning_scene::PlanningScene read(model);
  ASSERT_TRUE(read.setPlanningSceneMsg(get()));
  EXPECT_EQ(3.0, read.getWorld()->getObject("stays")->pose_.translation().x());
  collision_detection::AllowedCollision::Type type = collision_detection::AllowedCollision::NEVER;
  EXPECT_TRUE(read.getAllowedCollisionMatrix().getEntry("stays", "panda_hand", type));
  EXPECT_EQ(collision_detection::AllowedCollision::ALWAYS, type);
}

TEST_F(MoveItNames, ClearOctomapRemovesTheOctomapAndKeepsTheObjects)
{
  EXPECT_STREQ("std_srvs/Empty", ros::service_traits::datatype<MoveItEmpty>());
  const SerializedOctree octree =
      octreeOf({{Box{Eigen::Vector3d::Constant(0.1)}, Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.05, 0.05))}});
  moveit_msgs::PlanningScene scene = diff();
  scene.world.collision_objects = {moveItBox("stays", 1.0, 0.1)};
  scene.world.octomap.header.frame_id = model->getModelFrame();
  scene.world.octomap.origin.orientation.w = 1.0;
  scene.world.octomap.octomap.id = octree.id;
  scene.world.octomap.octomap.binary = 1;
  scene.world.octomap.octomap.resolution = octree.resolution;
  scene.world.octomap.octomap.data = octree.bytes;
  ASSERT_TRUE(apply(scene));
  EXPECT_FALSE(get().world.octomap.octomap.data.empty());
  roscpp::Empty call;
  EXPECT_TRUE(callPersistently("/clear_octomap", call));
  EXPECT_TRUE(get().world.octomap.octomap.data.empty());
  EXPECT_EQ(std::set<std::string>{"stays"}, objects());
}

TEST_F(MoveItNames, MoveItsOwnSceneFollowsTheNode)
{
  planning_scene::PlanningScene follower(model);
  std::mutex mutex;
  const auto take = [&](const moveit_msgs::PlanningSceneConstPtr& message)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    follower.usePlanningSceneMsg(*message);
  };
  moveit_msgs::PlanningScene before = diff();
  before.world.collision_objects = {moveItBox("before", 1.0, 0.1)};
  ASSERT_TRUE(apply(before));
  const ros::Subscriber subscriber = ros::NodeHandle().subscribe<moveit_msgs::PlanningScene>(
      "/move_group/monitored_planning_scene", 1000,
      boost::function<void(const moveit_msgs::PlanningSceneConstPtr&)>(take));
  std::string difference;
  const auto is_equal = [&]
  {
    moveit_msgs::PlanningScene message;
    const std::lock_guard<std::mutex> lock(mutex);
    follower.getPlanningSceneMsg(message);
    difference = differenceOf(get(), message);
    return difference.empty();
  };
  EXPECT_TRUE(waitFor(is_equal)) << "the whole scene comes first: " << difference;
  RandomChanges change(11);
  const auto parent = std::make_shared<planning_scene::PlanningScene>(model);
  parent->getCurrentStateNonConst().setToDefaultValues();
  const planning_scene::PlanningScenePtr scene = parent->diff();
  for (int i = 0; i < 100; ++i)
  {
    change(*scene);
    moveit_msgs::PlanningScene message;
    scene->getPlanningSceneDiffMsg(message);
    scene->pushDiffs(parent);
    scene->clearDiffs();
    ASSERT_TRUE(apply(message)) << i;
  }
  EXPECT_TRUE(waitFor(is_equal)) << difference;
}

TEST_F(MoveItNames, MoveItsOwnSceneFollowsTheJoints)
{
  planning_scene::PlanningScene follower(model);
  std::mutex mutex;
  const auto take = [&](const moveit_msgs::PlanningSceneConstPtr& message)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    follower.usePlanningSceneMsg(*message);
  };
  const ros::Subscriber subscriber = ros::NodeHandle().subscribe<moveit_msgs::PlanningScene>(
      "/move_group/monitored_planning_scene", 1000,
      boost::function<void(const moveit_msgs::PlanningSceneConstPtr&)>(take));
  for (const double angle : {0.4, -0.7})
  {
    moveit_msgs::PlanningScene turned = diff();
    turned.robot_state.joint_state.name = {"panda_joint1", "panda_finger_joint1"};
    turned.robot_state.joint_state.position = {angle, 0.02};
    ASSERT_TRUE(apply(turned));
    const auto has_turned = [&]
    {
      const std::lock_guard<std::mutex> lock(mutex);
      const moveit::core::RobotState& state = follower.getCurrentState();
      return state.getVariablePosition("panda_joint1") == angle &&
             state.getVariablePosition("panda_finger_joint1") == 0.02 &&
             state.getVariablePosition("panda_finger_joint2") == 0.02;
    };
    EXPECT_TRUE(waitFor(has_turned)) << angle;
  }
}

TEST_F(MoveItNames, TheCurrentStateIsCheckedWithContacts)
{
  const auto free = validity({});
  ASSERT_TRUE(free);
  EXPECT_TRUE(free->valid);
  EXPECT_TRUE(free->contacts.empty());
  moveit_msgs::PlanningScene scene = diff();
  scene.world.collision_objects = {boxAtHand(0.1)};
  ASSERT_TRUE(apply(scene));
  for (const std::string service : {"/check_state_validity", "/named/check_state_validity"})
  {
    const auto answer = validity({}, service);
    ASSERT_TRUE(answer);
    EXPECT_FALSE(answer->valid);
    ASSERT_FALSE(answer->contacts.empty());
    const moveit_msgs::ContactInformation& contact = answer->contacts.front();
    EXPECT_EQ("world", contact.header.frame_id);
    EXPECT_TRUE(contact.contact_body_1 == "box" || contact.contact_body_2 == "box");
    EXPECT_EQ(moveit_msgs::ContactInformation::WORLD_OBJECT,
              contact.contact_body_1 == "box" ? contact.body_type_1 : contact.body_type_2);
    EXPECT_GT(contact.depth, 0.0);
    EXPECT_NEAR(1.0, Eigen::Vector3d(contact.normal.x, contact.normal.y, contact.normal.z).norm(), 1e-9);
    EXPECT_LT((Eigen::Vector3d(contact.position.x, contact.position.y, contact.position.z) - hand()).norm(), 0.2);
  }
}

TEST_F(MoveItNames, TheStateOfTheRequestIsCheckedForItsGroup)
{
  moveit_msgs::PlanningScene scene = diff();
  scene.world.collision_objects = {boxAtHand(0.1)};
  ASSERT_TRUE(apply(scene));
  moveit_msgs::GetStateValidity::Request request;
  request.robot_state.is_diff = true;
  request.robot_state.joint_state.name = {"panda_joint1"};
  request.robot_state.joint_state.position = {2.0};
  request.group_name = "panda_arm";
  EXPECT_TRUE(validity(request)->valid);
  request.robot_state.joint_state.position = {0.0};
  EXPECT_FALSE(validity(request)->valid);
  request.group_name = "no_such_group";
  EXPECT_FALSE(validity(request)) << "the call fails";
}

TEST_F(MoveItNames, AStateThatWouldBeCheckedAsAnotherOneIsRefused)
{
  moveit_msgs::GetStateValidity::Request request;
  request.robot_state.is_diff = true;
  request.robot_state.joint_state.name = {"panda_joint_1"};
  request.robot_state.joint_state.position = {1.0};
  EXPECT_FALSE(validity(request)) << "the robot has no such joint";
  // The second finger follows the first one.
  request.robot_state.joint_state.name = {"panda_finger_joint1", "panda_finger_joint2"};
  request.robot_state.joint_state.position = {0.0, 0.04};
  EXPECT_FALSE(validity(request));
  request.robot_state.joint_state.position = {0.03, 0.03};
  EXPECT_TRUE(validity(request));
}

TEST_F(MoveItNames, ObjectsOfTheRequestCountForThisRequestAlone)
{
  moveit_msgs::PlanningScene scene = diff();
  moveit_msgs::CollisionObject beside = boxAtHand(0.1);
  beside.pose.position.x += 0.6;
  scene.world.collision_objects = {beside};
  ASSERT_TRUE(apply(scene));
  moveit_msgs::GetStateValidity::Request request;
  request.robot_state.is_diff = true;
  request.robot_state.attached_collision_objects = {carriedBox(1.2)};
  const auto answer = validity(request);
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->valid);
  const auto is_carried = [](const moveit_msgs::ContactInformation& contact)
  {
    return (contact.contact_body_1 == "carried" &&
            contact.body_type_1 == moveit_msgs::ContactInformation::ROBOT_ATTACHED) ||
           (contact.contact_body_2 == "carried" &&
            contact.body_type_2 == moveit_msgs::ContactInformation::ROBOT_ATTACHED);
  };
  EXPECT_TRUE(std::any_of(answer->contacts.begin(), answer->contacts.end(), is_carried));
  EXPECT_TRUE(validity({})->valid);
  EXPECT_TRUE(get().robot_state.attached_collision_objects.empty());
}

TEST_F(MoveItNames, AWholeStateInTheRequestReplacesTheAttachedObjects)
{
  moveit_msgs::PlanningScene scene = diff();
  moveit_msgs::CollisionObject beside = boxAtHand(0.1);
  beside.pose.position.x += 0.6;
  scene.world.collision_objects = {beside};
  scene.robot_state.attached_collision_objects = {carriedBox(1.2)};
  ASSERT_TRUE(apply(scene));
  moveit_msgs::GetStateValidity::Request request;
  request.robot_state = get().robot_state;
  EXPECT_FALSE(validity(request)->valid);
  request.robot_state.attached_collision_objects.clear();
  EXPECT_TRUE(validity(request)->valid) << "is_diff is false, so the state carries nothing";
  request.robot_state.is_diff = true;
  EXPECT_FALSE(validity(request)->valid);
}

TEST_F(MoveItNames, ConstraintsAreRefused)
{
  moveit_msgs::GetStateValidity::Request request;
  request.constraints.joint_constraints.resize(1);
  EXPECT_FALSE(validity(request)) << "the call fails";
}

TEST_F(MoveItNames, ASecondNodeDoesNotTakeTheNames)
{
  const pid_t second = fork();
  if (second == 0)
  {
    execl(GPS_NODE, GPS_NODE, "__name:=second", "_device:=cpu", "_moveit_names:=true", nullptr);
    _exit(127);
  }
  int status = 0;
  ASSERT_EQ(second, waitpid(second, &status, 0));
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(1, WEXITSTATUS(status));
  EXPECT_TRUE(validity({}));
}
}  // namespace
}  // namespace gpu_planning_scene::core
