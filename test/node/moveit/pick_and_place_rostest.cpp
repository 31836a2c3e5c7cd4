// Pick and place as a client of MoveIt writes it, with setPoseTarget and computeCartesianPath. The planner of this
// package is loaded as a plugin of MoveIt, and the node has the names of a move_group. MoveIt's FCL detector and its
// KinematicConstraintSet judge all motions, between their waypoints too.

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <moveit/kinematic_constraints/kinematic_constraint.h>
#include <moveit/kinematic_constraints/utils.h>
#include <moveit/planning_interface/planning_interface.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/robot_state/conversions.h>
#include <moveit/robot_trajectory/robot_trajectory.h>
#include <moveit_msgs/ApplyPlanningScene.h>
#include <moveit_msgs/GetCartesianPath.h>
#include <moveit_msgs/GetPlanningScene.h>
#include <pluginlib/class_loader.hpp>

#include "moveit/moveit_resources.h"
#include "node/child_node.h"
#include "node/messages/pose_messages.h"
#include "node/moveit/moveit_client.h"
#include "node/persistent_call.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using moveit_msgs::MoveItErrorCodes;
using robot_trajectory::RobotTrajectory;

constexpr char kArm[] = "panda_arm";
constexpr char kTip[] = "panda_link8";
constexpr char kHand[] = "panda_hand";
constexpr char kParameters[] = "/pick_and_place";

// Metres. The hand points down, and the fingers hold the object below it.
constexpr double kTable = 0.3;           // height
constexpr double kGap = 0.005;           // between an object and the table on which it stands
constexpr double kWidth = 0.02;          // of the object
constexpr double kHeight = 0.06;         // of the object
constexpr double kBelowHand = 0.105;     // the centre of the object
constexpr double kApproach = 0.12;       // length
constexpr double kDeviation = 3e-4;      // of a Cartesian path from its line
constexpr double kTiltOfLine = 2e-3;     // radians
constexpr double kTiltOfCarrying = 0.3;  // radians

class PickAndPlace : public testing::Test
{
 protected:
  static void SetUpTestSuite()
  {
    model = moveItPanda();
    useBuiltPlugins();
    ros::param::set(std::string(kParameters) + "/device", "cpu");
    loader = std::make_unique<Loader>("moveit_core", "planning_interface::PlannerManager");
    planner = loader->createUniqueInstance("gpu_planning_scene/PlannerManager");
    ASSERT_TRUE(planner->initialize(model, kParameters));
    node = std::make_unique<ChildNode>("picking", std::vector<std::string>{"_device:=cpu", "_moveit_names:=true"});
  }
  static void TearDownTestSuite()
  {
    node.reset();
    planner.reset();
    loader.reset();
    model.reset();
    ros::param::del(kParameters);
  }

  /// Two tables with a wall between them, and an object on the first table. The gripper is open.
  void SetUp() override
  {
    scene_ = std::make_shared<planning_scene::PlanningScene>(model);
    moveit::core::RobotState& state = scene_->getCurrentStateNonConst();
    state.setToDefaultValues();
    state.setToDefaultValues(model->getJointModelGroup(kArm), "ready");
    state.setToDefaultValues(model->getJointModelGroup("hand"), "open");
    state.update();
    moveit_msgs::PlanningScene empty;
    scene_->getPlanningSceneMsg(empty);
    ASSERT_TRUE(applyToNode(empty));
    moveit_msgs::PlanningScene diff = emptyDiff();
    diff.world.collision_objects = {
        boxAt("first_table", {0.5, -0.3, 0.5 * kTable}, {0.3, 0.3, kTable}),
        boxAt("second_table", {0.5, 0.3, 0.5 * kTable}, {0.3, 0.3, kTable}),
        boxAt("wall", {0.62, 0.0, 0.3}, {0.3, 0.02, 0.6}),
        boxAt("object", grasp().translation() - kBelowHand * Vector3d::UnitZ(), {kWidth, kWidth, kHeight})};
    ASSERT_TRUE(apply(diff));
    ASSERT_FALSE(scene_->isStateColliding());
  }

  /// The pose of the tip at an object that stands on a table.
  Isometry3d tipOver(double x, double y) const
  {
    Isometry3d pose = ready().getGlobalLinkTransform(kTip);
    pose.translation() = Vector3d(x, y, kTable + kGap + 0.5 * kHeight + kBelowHand);
    return pose;
  }
  Isometry3d grasp() const { return tipOver(0.45, -0.3); }
  Isometry3d place() const { return tipOver(0.45, 0.3); }

  static Isometry3d raised(Isometry3d pose, double by = kApproach)
  {
    pose.translation().z() += by;
    return pose;
  }

  static moveit::core::RobotState ready()
  {
    moveit::core::RobotState state(model);
    state.setToDefaultValues();
    state.setToDefaultValues(model->getJointModelGroup(kArm), "ready");
    state.update();
    return state;
  }

  static moveit_msgs::CollisionObject boxAt(const std::string& id, const Vector3d& place, const Vector3d& size)
  {
    moveit_msgs::CollisionObject object = moveItBox(id, place.x(), 0.0);
    object.pose.position.y = place.y();
    object.pose.position.z = place.z();
    object.primitives[0].dimensions.assign(size.data(), size.data() + 3);
    return object;
  }

  static moveit_msgs::PlanningScene emptyDiff()
  {
    moveit_msgs::PlanningScene diff;
    diff.is_diff = true;
    diff.robot_state.is_diff = true;
    return diff;
  }

  static bool applyToNode(const moveit_msgs::PlanningScene& scene)
  {
    moveit_msgs::ApplyPlanningScene call;
    call.request.scene = scene;
    EXPECT_TRUE(callPersistently("/apply_planning_scene", call));
    return call.response.success;
  }

  /// Changes the scene of MoveIt and that of the node.
  bool apply(const moveit_msgs::PlanningScene& diff)
  {
    return scene_->setPlanningSceneDiffMsg(diff) && applyToNode(diff);
  }

  bool applyState(const moveit::core::RobotState& state)
  {
    moveit_msgs::PlanningScene diff = emptyDiff();
    moveit::core::robotStateToRobotStateMsg(state, diff.robot_state, false);
    diff.robot_state.is_diff = true;
    return apply(diff);
  }

  bool moveFingers(double opening)
  {
    moveit::core::RobotState state = scene_->getCurrentState();
    state.setVariablePosition("panda_finger_joint1", opening);
    state.update();
    return applyState(state);
  }

  bool attachOrDetach(std::int8_t operation)
  {
    moveit_msgs::PlanningScene diff = emptyDiff();
    moveit_msgs::AttachedCollisionObject attached;
    attached.link_name = kHand;
    attached.object.id = "object";
    attached.object.operation = operation;
    attached.touch_links = {kHand, "panda_leftfinger", "panda_rightfinger"};
    diff.robot_state.attached_collision_objects = {attached};
    return apply(diff);
  }
  bool closeAndAttach() { return attachOrDetach(moveit_msgs::CollisionObject::ADD) && moveFingers(0.5 * kWidth); }
  bool openAndDetach() { return moveFingers(0.035) && attachOrDetach(moveit_msgs::CollisionObject::REMOVE); }

  /// Expects that the states of a path are free, and that they fulfil the constraints: 100 states in each motion
  /// between two waypoints.
  void expectValid(const RobotTrajectory& path, const moveit_msgs::Constraints& constraints) const
  {
    kinematic_constraints::KinematicConstraintSet wanted(model);
    ASSERT_TRUE(wanted.add(constraints, scene_->getTransforms()));
    moveit::core::RobotState state = path.getFirstWayPoint();
    for (std::size_t i = 1; i < path.getWayPointCount(); ++i)
      for (int k = 0; k <= 100; ++k)
      {
        path.getWayPoint(i - 1).interpolate(path.getWayPoint(i), 0.01 * k, state);
        state.update();
        ASSERT_FALSE(scene_->isStateColliding(state)) << "in motion " << i << " of " << path.getWayPointCount();
        ASSERT_TRUE(wanted.decide(state).satisfied) << "in motion " << i << " of " << path.getWayPointCount();
      }
  }

  /// Expects that a path begins at the current state and ends at the goal, and lets the robot move to its end.
  void execute(const RobotTrajectory& path, const moveit_msgs::Constraints& goal)
  {
    EXPECT_LT(path.getFirstWayPoint().distance(scene_->getCurrentState()), 1e-6);
    kinematic_constraints::KinematicConstraintSet wanted(model);
    ASSERT_TRUE(wanted.add(goal, scene_->getTransforms()));
    EXPECT_TRUE(wanted.decide(path.getLastWayPoint()).satisfied);
    ASSERT_TRUE(applyState(path.getLastWayPoint()));
  }

  static geometry_msgs::PoseStamped inWorld(const Isometry3d& pose)
  {
    geometry_msgs::PoseStamped message;
    message.header.frame_id = "world";
    message.pose = poseOf(pose);
    return message;
  }

  /// The tip keeps its orientation up to a tilt. `turn`: about its own axis.
  moveit_msgs::Constraints keepsOrientation(double tilt, double turn) const
  {
    moveit_msgs::Constraints constraints;
    moveit_msgs::OrientationConstraint orientation;
    orientation.header.frame_id = "world";
    orientation.link_name = kTip;
    orientation.orientation = orientationOf(ready().getGlobalLinkTransform(kTip));
    orientation.absolute_x_axis_tolerance = orientation.absolute_y_axis_tolerance = tilt;
    orientation.absolute_z_axis_tolerance = turn;
    orientation.weight = 1.0;
    constraints.orientation_constraints = {orientation};
    return constraints;
  }

  /// The tip stays on the vertical line from its pose to another one.
  moveit_msgs::Constraints staysOnLineTo(const Isometry3d& end) const
  {
    const Vector3d begin = scene_->getCurrentState().getGlobalLinkTransform(kTip).translation();
    moveit_msgs::Constraints constraints = keepsOrientation(kTiltOfLine, kTiltOfLine);
    moveit_msgs::PositionConstraint position;
    position.header.frame_id = "world";
    position.link_name = kTip;
    position.constraint_region.primitives.resize(1);
    position.constraint_region.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
    position.constraint_region.primitives[0].dimensions = {
        2.0 * kDeviation, 2.0 * kDeviation, std::abs(end.translation().z() - begin.z()) + 2.0 * kDeviation};
    position.constraint_region.primitive_poses = {
        poseOf(Isometry3d(Eigen::Translation3d(0.5 * (begin + end.translation()))))};
    position.weight = 1.0;
    constraints.position_constraints = {position};
    return constraints;
  }

  /// A request of MoveGroupInterface after setPoseTarget and setPathConstraints, with its tolerances.
  static planning_interface::MotionPlanRequest requestTo(const Isometry3d& pose,
                                                         const moveit_msgs::Constraints& path_constraints = {})
  {
    planning_interface::MotionPlanRequest request;
    request.group_name = kArm;
    request.allowed_planning_time = 30.0;
    request.num_planning_attempts = 1;
    request.start_state.is_diff = true;
    request.goal_constraints = {kinematic_constraints::constructGoalConstraints(kTip, inWorld(pose), 1e-4, 1e-3)};
    request.path_constraints = path_constraints;
    return request;
  }

  /// Returns a code of MoveItErrorCodes.
  int plan(const planning_interface::MotionPlanRequest& request, planning_interface::MotionPlanResponse& response) const
  {
    moveit_msgs::MoveItErrorCodes code;
    const planning_interface::PlanningContextPtr context = planner->getPlanningContext(scene_, request, code);
    if (!context)
      return code.val;
    context->solve(response);
    return response.error_code_.val;
  }

  void planTo(const Isometry3d& pose, const moveit_msgs::Constraints& path_constraints = {})
  {
    const planning_interface::MotionPlanRequest request = requestTo(pose, path_constraints);
    planning_interface::MotionPlanResponse response;
    ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(request, response));
    expectValid(*response.trajectory_, path_constraints);
    execute(*response.trajectory_, request.goal_constraints[0]);
  }

  /// The answer of computeCartesianPath, whose states are valid. `fraction`: of the answer.
  std::shared_ptr<RobotTrajectory> lineTo(const Isometry3d& pose, double& fraction) const
  {
    moveit_msgs::GetCartesianPath call;
    call.request.header.frame_id = "world";
    call.request.start_state.is_diff = true;
    call.request.group_name = kArm;
    call.request.link_name = kTip;
    call.request.waypoints = {poseOf(pose)};
    call.request.max_step = 0.01;
    call.request.avoid_collisions = 1;
    EXPECT_TRUE(callPersistently("/compute_cartesian_path", call));
    EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), call.response.error_code.val);
    fraction = call.response.fraction;
    auto path = std::make_shared<RobotTrajectory>(model, kArm);
    path->setRobotTrajectoryMsg(scene_->getCurrentState(), call.response.solution);
    expectValid(*path, staysOnLineTo(pose));
    return path;
  }

  void moveStraightTo(const Isometry3d& pose)
  {
    double fraction = 0.0;
    const std::shared_ptr<RobotTrajectory> path = lineTo(pose, fraction);
    ASSERT_EQ(1.0, fraction);
    execute(*path, kinematic_constraints::constructGoalConstraints(kTip, inWorld(pose), kDeviation, kTiltOfLine));
  }

  void pick()
  {
    ASSERT_NO_FATAL_FAILURE(planTo(raised(grasp())));
    ASSERT_NO_FATAL_FAILURE(moveStraightTo(grasp()));
    ASSERT_TRUE(closeAndAttach());
  }

  using Loader = pluginlib::ClassLoader<planning_interface::PlannerManager>;
  static inline moveit::core::RobotModelPtr model;
  static inline std::unique_ptr<Loader> loader;
  static inline planning_interface::PlannerManagerPtr planner;
  static inline std::unique_ptr<ChildNode> node;
  planning_scene::PlanningScenePtr scene_;
};

TEST_F(PickAndPlace, MovesTheObjectOverTheWallWithoutCollision)
{
  ASSERT_NO_FATAL_FAILURE(pick());
  ASSERT_NO_FATAL_FAILURE(moveStraightTo(raised(grasp())));
  ASSERT_NO_FATAL_FAILURE(planTo(raised(place()), keepsOrientation(kTiltOfCarrying, 2.0 * M_PI)));
  ASSERT_NO_FATAL_FAILURE(moveStraightTo(place()));
  ASSERT_TRUE(openAndDetach());
  ASSERT_NO_FATAL_FAILURE(moveStraightTo(raised(place())));
  ASSERT_NO_FATAL_FAILURE(planTo(ready().getGlobalLinkTransform(kTip)));

  moveit_msgs::GetPlanningScene call;
  ASSERT_TRUE(callPersistently("/get_planning_scene", call));
  EXPECT_TRUE(call.response.scene.robot_state.attached_collision_objects.empty());
  planning_scene::PlanningScene of_node(model);
  ASSERT_TRUE(of_node.setPlanningSceneMsg(call.response.scene));
  const Vector3d end = place().translation() - kBelowHand * Vector3d::UnitZ();
  for (const planning_scene::PlanningScene* scene : {&of_node, scene_.get()})
  {
    ASSERT_TRUE(scene->getWorld()->hasObject("object"));
    EXPECT_LT((scene->getFrameTransform("object").translation() - end).norm(), 2.0 * kDeviation);
  }
}

TEST_F(PickAndPlace, ALineEndsAboveTheTable)
{
  Isometry3d beside = grasp();
  beside.translation().x() += 0.1;
  ASSERT_NO_FATAL_FAILURE(planTo(raised(beside)));
  double fraction = 0.0;
  lineTo(raised(beside, -0.1), fraction);
  EXPECT_LT(0.5, fraction);
  EXPECT_LT(fraction, 1.0);
}

TEST_F(PickAndPlace, TheCarriedObjectDoesNotEnterTheTable)
{
  ASSERT_NO_FATAL_FAILURE(pick());
  const Isometry3d lower = raised(grasp(), -3.0 * kGap);
  double fraction = 1.0;
  lineTo(lower, fraction);
  EXPECT_LT(fraction, 0.5);
  planning_interface::MotionPlanResponse response;
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(requestTo(lower), response));
  // The gripper alone does not meet the table there.
  ASSERT_TRUE(openAndDetach());
  moveit_msgs::PlanningScene diff = emptyDiff();
  diff.world.collision_objects.resize(1);
  diff.world.collision_objects[0].id = "object";
  diff.world.collision_objects[0].operation = moveit_msgs::CollisionObject::REMOVE;
  ASSERT_TRUE(apply(diff));
  lineTo(lower, fraction);
  EXPECT_EQ(1.0, fraction);
  planTo(lower);
}
}  // namespace
}  // namespace gpu_planning_scene::core
