#include "node/node_client.h"

#include <random>

#include "gpu_planning_scene/cpu_checker.h"
#include "node/messages/pose_messages.h"
#include "node/parameters/node_parameters.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core
{
std::shared_ptr<const RobotModel> RunningNode::robot;
std::vector<double> RunningNode::free_state;
std::string RunningNode::tip;
std::string RunningNode::base;

namespace
{
std::string parameter(const std::string& name)
{
  return ros::param::param<std::string>("~" + name, "");
}

/// A point in the shape's frame: the centre of a primitive; a point on the first triangle of a mesh.
Eigen::Vector3d pointOf(const Shape& shape)
{
  const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape);
  if (mesh == nullptr)
    return Eigen::Vector3d::Zero();
  const auto& triangle = (*mesh)->triangles.front();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto corner : triangle)
    sum += (*mesh)->vertices[static_cast<std::size_t>(corner)] / 3.0;
  return sum;
}
}  // namespace

geometry_msgs::Pose poseAt(const Eigen::Isometry3d& pose)
{
  return poseOf(pose);
}

geometry_msgs::Pose poseAt(const Eigen::Vector3d& position)
{
  return poseAt(Eigen::Isometry3d(Eigen::Translation3d(position)));
}

CollisionObject objectOperation(const std::string& id, std::int8_t operation)
{
  CollisionObject object;
  object.id = id;
  object.operation = operation;
  return object;
}

CollisionObject boxObject(const std::string& id, const Eigen::Vector3d& position, double size)
{
  CollisionObject object = objectOperation(id, CollisionObject::ADD);
  object.pose = poseAt(position);
  object.primitives.resize(1);
  object.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
  object.primitives[0].dimensions.assign(3, size);
  object.primitive_poses.push_back(poseAt(Eigen::Vector3d(Eigen::Vector3d::Zero())));
  return object;
}

PlanningSceneMessage diffScene()
{
  PlanningSceneMessage change;
  change.is_diff = true;
  change.robot_state.is_diff = true;
  return change;
}

PlanningSceneMessage diffWith(const CollisionObject& object)
{
  PlanningSceneMessage change = diffScene();
  change.world.collision_objects.push_back(object);
  return change;
}

PlanningSceneMessage diffWith(const AttachedCollisionObject& object)
{
  PlanningSceneMessage change = diffScene();
  change.robot_state.attached_collision_objects.push_back(object);
  return change;
}

void RunningNode::SetUpTestSuite()
{
  RobotModelOptions options;
  XmlRpc::XmlRpcValue packages;
  if (ros::param::get("~packages", packages))
    options.packages = packageResolver(packageFolders(packages));
  robot = RobotModel::fromFiles(parameter("urdf"), parameter("srdf"), options);
  for (const Link& link : robot->links())
  {
    if (link.shapes.empty())
      continue;
    base = base.empty() ? link.name : base;
    tip = link.name;
  }
  CpuChecker checker(std::make_shared<const PlanningScene>(robot));
  std::mt19937_64 generator(1);
  free_state.resize(robot->variables().size());
  do
    robot->randomState(generator, free_state.data());
  while (checker.check(free_state.data(), 1).valid[0] == 0);
  ASSERT_TRUE(ros::service::waitForService(name("check_states"), ros::Duration(180.0)));
}

void RunningNode::TearDownTestSuite()
{
  robot.reset();
}

void RunningNode::SetUp()
{
  PlanningSceneMessage empty;
  empty.robot_state = stateMessage(free_state);
  apply(empty);
}

std::uint64_t RunningNode::apply(const PlanningSceneMessage& change)
{
  ApplyPlanningScene::Request request;
  request.scene = change;
  const auto response = call<ApplyPlanningScene>("apply_planning_scene", request);
  EXPECT_TRUE(response.success) << response.message;
  return response.scene_revision;
}

void RunningNode::expectRefusal(const PlanningSceneMessage& change, const std::string& reason, std::uint8_t status)
{
  const PlanningSceneMessage before = scene();
  ApplyPlanningScene::Request request;
  request.scene = change;
  const auto response = call<ApplyPlanningScene>("apply_planning_scene", request);
  EXPECT_FALSE(response.success);
  EXPECT_EQ(status, response.status);
  EXPECT_NE(std::string::npos, response.message.find(reason)) << "'" << response.message << "' does not say " << reason;
  EXPECT_EQ(std::string::npos, response.message.find('\n')) << response.message;
  EXPECT_EQ(before, scene());
}

PlanningSceneMessage RunningNode::scene(std::uint32_t components)
{
  GetPlanningScene::Request request;
  request.components.components = components;
  const auto response = call<GetPlanningScene>("get_planning_scene", request);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(AnswerStatus::OK, response.status);
  return response.scene;
}

CheckStates::Request RunningNode::stateRequest(const std::vector<double>& states)
{
  CheckStates::Request request;
  for (const Variable& variable : robot->variables())
    request.joint_names.push_back(variable.name);
  request.positions = states;
  return request;
}

CheckStates::Response RunningNode::check(const std::vector<double>& state)
{
  auto response = call<CheckStates>("check_states", stateRequest(state));
  EXPECT_TRUE(response.success) << response.message;
  return response;
}

std::string RunningNode::collision()
{
  const CheckStates::Response response = check(free_state);
  if (response.valid.at(0) != 0)
    return "";
  return std::min(response.body_1[0], response.body_2[0]) + " " + std::max(response.body_1[0], response.body_2[0]);
}

RobotState RunningNode::stateMessage(const std::vector<double>& state)
{
  RobotState message;
  for (const Variable& variable : robot->variables())
    message.joint_state.name.push_back(variable.name);
  message.joint_state.position = state;
  return message;
}

Eigen::Isometry3d RunningNode::linkPose(const std::string& link, const std::vector<double>& state)
{
  return core::linkPose(*robot, robot->linkIndex(link), state.data());
}

Eigen::Vector3d RunningNode::tipPoint()
{
  const PlacedShape& placed = robot->links()[static_cast<std::size_t>(robot->linkIndex(tip))].shapes.front();
  return linkPose(tip, free_state) * placed.pose * pointOf(placed.shape);
}
}  // namespace gpu_planning_scene::core
