#include <cmath>
#include <string>

#include <moveit/kinematic_constraints/utils.h>
#include <moveit/robot_state/conversions.h>

#include "moveit/panda_planner.h"

// Goals of poses and path constraints, as MoveIt's move_group sends them. MoveIt's own KinematicConstraintSet judges
// whether they are fulfilled.
namespace gpu_planning_scene::pipeline
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using moveit::core::RobotState;
using moveit_msgs::MoveItErrorCodes;
using planning_interface::MotionPlanRequest;
using planning_interface::MotionPlanResponse;

constexpr char kTip[] = "panda_link8";

class PlannerGoals : public Planner
{
 protected:
  /// A pose, as setPoseTarget sends it.
  static geometry_msgs::PoseStamped messageOf(const Isometry3d& pose)
  {
    geometry_msgs::PoseStamped message;
    message.header.frame_id = "world";
    const Eigen::Quaterniond rotation(pose.linear());
    message.pose.position.x = pose.translation().x();
    message.pose.position.y = pose.translation().y();
    message.pose.position.z = pose.translation().z();
    message.pose.orientation.x = rotation.x();
    message.pose.orientation.y = rotation.y();
    message.pose.orientation.z = rotation.z();
    message.pose.orientation.w = rotation.w();
    return message;
  }

  static geometry_msgs::PoseStamped poseOf(const RobotState& state)
  {
    return messageOf(state.getGlobalLinkTransform(kTip));
  }

  MotionPlanRequest poseRequest(const geometry_msgs::PoseStamped& pose, const std::string& link = kTip) const
  {
    MotionPlanRequest asked = request(goal_);
    asked.goal_constraints = {kinematic_constraints::constructGoalConstraints(link, pose)};
    return asked;
  }

  /// The tip keeps the orientation that it has in a state, up to a tilt; it may turn about its own axis.
  static moveit_msgs::Constraints upright(const RobotState& state, double tilt)
  {
    moveit_msgs::Constraints constraints;
    moveit_msgs::OrientationConstraint orientation;
    orientation.header.frame_id = "world";
    orientation.link_name = kTip;
    orientation.orientation = poseOf(state).pose.orientation;
    orientation.absolute_x_axis_tolerance = tilt;
    orientation.absolute_y_axis_tolerance = tilt;
    orientation.absolute_z_axis_tolerance = 2.0 * M_PI;
    orientation.weight = 1.0;
    constraints.orientation_constraints.push_back(orientation);
    return constraints;
  }
};

TEST_F(PlannerGoals, APoseIsReachedWithoutCollision)
{
  addPost();
  const MotionPlanRequest asked = poseRequest(poseOf(goal_));
  EXPECT_TRUE(manager().canServiceRequest(asked));
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_EQ(0, collidingStates(*response.trajectory_));
  EXPECT_TRUE(fulfils(response.trajectory_->getLastWayPoint(), asked.goal_constraints[0]));
}

TEST_F(PlannerGoals, APositionAloneLeavesTheOrientationFree)
{
  const geometry_msgs::PoseStamped pose = poseOf(goal_);
  geometry_msgs::PointStamped point;
  point.header = pose.header;
  point.point = pose.pose.position;
  MotionPlanRequest asked = request(goal_);
  asked.goal_constraints = {kinematic_constraints::constructGoalConstraints(kTip, point, 0.01)};
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_TRUE(fulfils(response.trajectory_->getLastWayPoint(), asked.goal_constraints[0]));
}

TEST_F(PlannerGoals, AnyOfSeveralGoalsWillDo)
{
  geometry_msgs::PoseStamped far = poseOf(goal_);
  far.pose.position.x = 5.0;
  MotionPlanRequest asked = poseRequest(far);
  EXPECT_EQ(int(MoveItErrorCodes::NO_IK_SOLUTION), plan(asked));
  asked.goal_constraints.push_back(
      kinematic_constraints::constructGoalConstraints(goal_, robot()->getJointModelGroup(kArm), 1e-4));
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_TRUE(fulfils(response.trajectory_->getLastWayPoint(), asked.goal_constraints[1]));
}

TEST_F(PlannerGoals, AGoalThatIsFilledIsInCollision)
{
  addBoxInGoal();
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_IN_COLLISION), plan(poseRequest(poseOf(goal_))));
}

TEST_F(PlannerGoals, AnAttachedObjectHasAPoseToo)
{
  attachBox(kHandLinks, {0.02, 0.02, 0.1}, at(0.0, 0.0, 0.16));
  RobotState carrying = goal_;
  carrying.attachBody("tool", at(0.0, 0.0, 0.16), {box(0.02, 0.02, 0.1)}, {Isometry3d::Identity()}, kHandLinks,
                      "panda_hand");
  carrying.update();
  geometry_msgs::PoseStamped pose = poseOf(goal_);
  const Vector3d tool = carrying.getFrameTransform("tool").translation();
  pose.pose.position.x = tool.x();
  pose.pose.position.y = tool.y();
  pose.pose.position.z = tool.z();
  MotionPlanRequest asked = poseRequest(pose, "tool");
  asked.goal_constraints[0].orientation_constraints.clear();
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_NEAR(0.0, (response.trajectory_->getLastWayPoint().getFrameTransform("tool").translation() - tool).norm(),
              1e-3);
}

TEST_F(PlannerGoals, AnObjectIsPickedAndPlaced)
{
  // The steps of MoveIt's tutorial: to the object, attach it, to the place, detach it, and away.
  const Isometry3d grasp = goal_.getGlobalLinkTransform(kTip);
  const Vector3d object = (goal_.getGlobalLinkTransform("panda_hand") * at(0.0, 0.0, 0.14)).translation();
  addObject("table", box(0.3, 0.3, 0.02), at(object.x(), object.y(), object.z() - 0.065));
  addObject("object", box(0.02, 0.02, 0.1), at(object.x(), object.y(), object.z()));
  const auto move_to = [&](const Isometry3d& pose)
  {
    const MotionPlanRequest asked = poseRequest(messageOf(pose));
    MotionPlanResponse response;
    ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
    EXPECT_EQ(0, collidingStates(*response.trajectory_));
    EXPECT_TRUE(fulfils(response.trajectory_->getLastWayPoint(), asked.goal_constraints[0]));
    scene_->setCurrentState(response.trajectory_->getLastWayPoint());
  };
  collision_detection::AllowedCollisionMatrix& matrix = scene_->getAllowedCollisionMatrixNonConst();
  for (const std::string& link : kHandLinks)
    matrix.setEntry("object", link, true);
  move_to(grasp);

  moveit_msgs::AttachedCollisionObject attached;
  attached.link_name = "panda_hand";
  attached.object.id = "object";
  attached.object.operation = moveit_msgs::CollisionObject::ADD;
  attached.touch_links.assign(kHandLinks.begin(), kHandLinks.end());
  ASSERT_TRUE(scene_->processAttachedCollisionObjectMsg(attached));
  Isometry3d place = grasp;
  place.translation().z() += 0.1;
  move_to(place);
  place.prerotate(Eigen::AngleAxisd(-1.5, Vector3d::UnitZ()));
  place.translation() =
      Eigen::AngleAxisd(-1.5, Vector3d::UnitZ()) * Vector3d(grasp.translation() + Vector3d(0.0, 0.0, 0.1));
  move_to(place);
  EXPECT_TRUE(scene_->getCurrentState().hasAttachedBody("object"));

  attached.object.operation = moveit_msgs::CollisionObject::REMOVE;
  ASSERT_TRUE(scene_->processAttachedCollisionObjectMsg(attached));
  EXPECT_TRUE(scene_->getWorld()->hasObject("object"));
  place.translation().z() += 0.1;
  move_to(place);
}

TEST_F(PlannerGoals, PathConstraintsHoldBetweenWaypoints)
{
  const Vector3d middle =
      0.5 * (start_.getGlobalLinkTransform(kTip).translation() + goal_.getGlobalLinkTransform(kTip).translation());
  addObject("post", box(0.1, 0.1, 1.0), at(middle.x() + 0.3, middle.y(), 0.4));
  MotionPlanRequest asked = poseRequest(poseOf(goal_));
  asked.path_constraints = upright(start_, 0.15);
  ASSERT_TRUE(fulfils(start_, asked.path_constraints));
  ASSERT_TRUE(fulfils(goal_, asked.path_constraints));
  MotionPlanResponse response;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan(asked, response));
  EXPECT_EQ(0, collidingStates(*response.trajectory_));
  const robot_trajectory::RobotTrajectory& path = *response.trajectory_;
  RobotState state = path.getFirstWayPoint();
  for (std::size_t i = 1; i < path.getWayPointCount(); ++i)
    for (int k = 0; k <= 20; ++k)
    {
      path.getWayPoint(i - 1).interpolate(path.getWayPoint(i), 0.05 * k, state);
      state.update();
      ASSERT_TRUE(fulfils(state, asked.path_constraints)) << "between waypoints " << i - 1 << " and " << i;
    }
}

TEST_F(PlannerGoals, StartsAndGoalsOutsideThePathConstraintsAreNamed)
{
  RobotState tilted = goal_;
  tilted.setVariablePosition("panda_joint6", 2.6);
  tilted.update();
  MotionPlanRequest asked = poseRequest(poseOf(goal_));
  asked.path_constraints = upright(tilted, 0.1);
  EXPECT_EQ(int(MoveItErrorCodes::START_STATE_VIOLATES_PATH_CONSTRAINTS), plan(asked));
  asked = request(tilted);
  asked.path_constraints = upright(start_, 0.1);
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_VIOLATES_PATH_CONSTRAINTS), plan(asked));
}

TEST_F(PlannerGoals, WrongPosesAreRefusedWithTheirCause)
{
  const auto with = [this](const auto& change)
  {
    MotionPlanRequest asked = poseRequest(poseOf(goal_));
    change(asked.goal_constraints[0]);
    return plan(asked);
  };
  EXPECT_EQ(int(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE),
            with([](auto& goal) { goal.position_constraints[0].header.frame_id = "nowhere"; }));
  EXPECT_EQ(int(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE),
            with([](auto& goal) { goal.orientation_constraints[0].header.frame_id = "panda_link7"; }));
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_LINK_NAME),
            with([](auto& goal) { goal.position_constraints[0].link_name = "elbow"; }));
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS),
            with([](auto& goal) { goal.orientation_constraints[0].orientation.w = 5.0; }));
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS),
            with([](auto& goal) { goal.orientation_constraints[0].absolute_x_axis_tolerance = 0.0; }));
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS),
            with([](auto& goal) { goal.position_constraints[0].constraint_region.primitives[0].dimensions = {0.0}; }));
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS),
            with([](auto& goal) { goal.position_constraints[0].constraint_region.primitives.clear(); }));
}
}  // namespace
}  // namespace gpu_planning_scene::pipeline
