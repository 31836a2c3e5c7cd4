#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include <moveit/kinematic_constraints/kinematic_constraint.h>
#include <moveit/robot_model/planar_joint_model.h>

#include "moveit/planner_fixtures.h"

// The planner for MoveIt with planar and floating joints: workspace, rotations, refusals.
namespace gpu_planning_scene::pipeline
{
namespace
{
using moveit::core::RobotState;
using moveit_msgs::MoveItErrorCodes;

TEST_F(Cart, StaysInTheWorkspace)
{
  addWall(4.0);
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan());
  for (std::size_t i = 0; i < response_.trajectory_->getWayPointCount(); ++i)
  {
    const RobotState& waypoint = response_.trajectory_->getWayPoint(i);
    EXPECT_FALSE(scene_->isStateColliding(waypoint, "cart"));
    EXPECT_LE(std::abs(waypoint.getVariablePosition("drive/x")), 5.0);
    EXPECT_LE(std::abs(waypoint.getVariablePosition("drive/y")), 5.0);
  }
  setWorkspace(3.0);
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_STATE_INVALID), plan());
}

TEST_F(Cart, NeedsAWorkspaceInAKnownFrame)
{
  setWorkspace(0.0);
  EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED), plan());
  setWorkspace(5.0);
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan());
  request_.workspace_parameters.header.frame_id = "nowhere";
  EXPECT_EQ(int(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE), plan());
}

TEST_F(Cart, TakesTheWorkspaceInAFrameOfTheScene)
{
  scene_->getTransformsNonConst().setTransform(at(3.0, 0.0, 0.0), "hall");
  request_.workspace_parameters.header.frame_id = "hall";
  request_.workspace_parameters.max_corner.x = 2.0;
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan());
  request_.workspace_parameters.max_corner.x = 0.5;
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_STATE_INVALID), plan());
}

TEST_F(Cart, StartsWhereTheJointsOfTheRequestAre)
{
  sensor_msgs::MultiDOFJointState& joints = request_.start_state.multi_dof_joint_state;
  request_.start_state.is_diff = true;
  joints.header.frame_id = robot_->getModelFrame();
  joints.joint_names = {"drive"};
  joints.transforms.resize(1);
  joints.transforms[0].translation.x = 1.0;
  joints.transforms[0].rotation.w = 1.0;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan());
  EXPECT_EQ(1.0, response_.trajectory_->getFirstWayPoint().getVariablePosition("drive/x"));
  joints.header.frame_id = "nowhere";
  EXPECT_EQ(int(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE), plan());
  joints.header.frame_id = robot_->getModelFrame();
  joints.transforms[0].rotation.z = NAN;
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_ROBOT_STATE), plan());
  joints.transforms[0].rotation.z = 0.0;
  joints.joint_names = {"wheel"};
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_ROBOT_STATE), plan());
}

TEST_F(Cart, EndsWithTheTimeOrWhenItIsTerminated)
{
  addWall(20.0);  // across the workspace
  request_.allowed_planning_time = 0.3;
  EXPECT_EQ(int(MoveItErrorCodes::TIMED_OUT), plan());
  request_.allowed_planning_time = 100.0;
  std::atomic<bool> done{false};
  std::thread terminating(
      [&]
      {
        while (!done)
        {
          std::this_thread::sleep_for(std::chrono::milliseconds(50));
          manager_->terminate();
        }
      });
  EXPECT_EQ(int(MoveItErrorCodes::PREEMPTED), plan());
  EXPECT_LT(response_.planning_time_, 50.0);
  done = true;
  terminating.join();
}

TEST_F(Cart, RefusesAWorkspaceThatIsNoBoxOrIsRotated)
{
  const auto with = [this](const auto& change)
  {
    setWorkspace(5.0);
    change(request_.workspace_parameters);
    return plan();
  };
  EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED), with([](auto& workspace) { workspace.min_corner.x = NAN; }));
  EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED), with([](auto& workspace) { workspace.min_corner.y = 6.0; }));
  scene_->getTransformsNonConst().setTransform(Eigen::Isometry3d(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ())),
                                               "slope");
  EXPECT_EQ(int(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE),
            with([](auto& workspace) { workspace.header.frame_id = "slope"; }));
}

TEST_F(Cart, ReachesAnAngleThatIsGivenWithWholeTurns)
{
  for (moveit_msgs::JointConstraint& joint : request_.goal_constraints[0].joint_constraints)
    if (joint.joint_name == "drive/theta")
      joint.position = 2.0 * M_PI + 0.5;
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan());
  EXPECT_NEAR(0.5, response_.trajectory_->getLastWayPoint().getVariablePosition("drive/theta"), 1e-3);
}

TEST_F(Cart, IsNotPlannedForIfItTurnsBeforeItDrivesOrHasALimitedAngle)
{
  auto* drive = dynamic_cast<moveit::core::PlanarJointModel*>(robot_->getJointModel("drive"));
  drive->setMotionModel(moveit::core::PlanarJointModel::DIFF_DRIVE);
  EXPECT_FALSE(manager_->canServiceRequest(request_));
  EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED), plan());
  drive->setMotionModel(moveit::core::PlanarJointModel::HOLONOMIC);
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), plan());
  moveit::core::VariableBounds bounds = drive->getVariableBounds("drive/theta");
  bounds.min_position_ = -1.0;
  bounds.max_position_ = 1.0;
  bounds.position_bounded_ = true;
  drive->setVariableBounds("drive/theta", bounds);
  EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED), plan());
}

TEST_F(Cart, FulfilsSeveralConstraintsOfAJointUnlessTheyContradictEachOther)
{
  std::vector<moveit_msgs::JointConstraint>& joints = request_.goal_constraints[0].joint_constraints;
  joints.resize(2);
  joints[0].joint_name = joints[1].joint_name = "drive/x";
  for (moveit_msgs::JointConstraint& joint : joints)
    joint.tolerance_below = joint.tolerance_above = 0.5;
  for (const std::size_t first : {0U, 1U})
  {
    joints[first].position = 3.0;      // 2.5 to 3.5
    joints[1 - first].position = 3.9;  // 3.4 to 4.4
    ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), plan());
    const double x = response_.trajectory_->getLastWayPoint().getVariablePosition("drive/x");
    EXPECT_GE(x, 3.4 - 1e-9);
    EXPECT_LE(x, 3.5 + 1e-9);
  }
  joints[0].position = 3.0;
  joints[1].position = 4.5;
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), plan());
  joints[0].joint_name = joints[1].joint_name = "drive/theta";
  joints[0].position = joints[1].position = 0.5;
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), plan()) << "an angle has one constraint";
}

/// A box that flies, from the origin to a goal where it is turned.
class Drone : public testing::Test
{
 protected:
  Drone() : robot_(makeRobot()), scene_(std::make_shared<planning_scene::PlanningScene>(robot_))
  {
    scene_->getCurrentStateNonConst().setToDefaultValues();
    scene_->getCurrentStateNonConst().update();
    request_.group_name = "drone";
    request_.allowed_planning_time = 20.0;
    request_.workspace_parameters.min_corner.x = request_.workspace_parameters.min_corner.y =
        request_.workspace_parameters.min_corner.z = -3.0;
    request_.workspace_parameters.max_corner.x = request_.workspace_parameters.max_corner.y =
        request_.workspace_parameters.max_corner.z = 3.0;
    manager_ = loadManager(robot_);
  }

  static moveit::core::RobotModelPtr makeRobot()
  {
    moveit::core::RobotModelBuilder builder("drone", "body");
    geometry_msgs::Pose pose;
    pose.orientation.w = 1.0;
    builder.addCollisionBox("body", {0.6, 0.1, 0.1}, pose);
    builder.addVirtualJoint("world", "body", "floating", "fly");
    builder.addGroup({}, {"fly"}, "drone");
    return builder.build();
  }

  /// `rotation`: x, y, z, w.
  int planTo(const Eigen::Vector3d& place, const Eigen::Vector4d& rotation)
  {
    const std::vector<std::string>& names = robot_->getJointModel("fly")->getVariableNames();
    request_.goal_constraints.assign(1, moveit_msgs::Constraints());
    for (std::size_t i = 0; i < names.size(); ++i)
    {
      moveit_msgs::JointConstraint joint;
      joint.joint_name = names[i];
      joint.position = i < 3 ? place[static_cast<int>(i)] : rotation[static_cast<int>(i) - 3];
      joint.tolerance_above = joint.tolerance_below = 1e-3;
      request_.goal_constraints[0].joint_constraints.push_back(joint);
    }
    return plan();
  }

  int plan()
  {
    moveit_msgs::MoveItErrorCodes code;
    const planning_interface::PlanningContextPtr context = manager_->getPlanningContext(scene_, request_, code);
    if (!context)
      return code.val;
    context->solve(response_);
    return response_.error_code_.val;
  }

  moveit::core::RobotModelPtr robot_;
  planning_scene::PlanningScenePtr scene_;
  planning_interface::PlannerManagerPtr manager_;
  planning_interface::MotionPlanRequest request_;
  planning_interface::MotionPlanResponse response_;
};

TEST_F(Drone, FliesThroughASlitIntoWhichItFitsTurned)
{
  // The slit between the two walls is 0.3 m wide along y.
  for (const double side : {-1.0, 1.0})
    scene_->getWorldNonConst()->addToObject(side < 0.0 ? "left" : "right", at(1.5, side * 5.15, 0.0),
                                            box(0.1, 10.0, 10.0), Eigen::Isometry3d::Identity());
  const Eigen::Vector4d turned(0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5));  // along y
  scene_->getCurrentStateNonConst().setVariablePositions(std::vector<double>{0, 0, 0, 0, 0, turned[2], turned[3]});
  scene_->getCurrentStateNonConst().update();
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), planTo({2.5, 1.0, 1.0}, turned));
  RobotState state(robot_);
  for (std::size_t i = 1; i < response_.trajectory_->getWayPointCount(); ++i)
    for (int k = 0; k <= 20; ++k)
    {
      response_.trajectory_->getWayPoint(i - 1).interpolate(response_.trajectory_->getWayPoint(i), 0.05 * k, state);
      state.update();
      EXPECT_FALSE(scene_->isStateColliding(state, "drone"));
    }
  const Eigen::Isometry3d end = response_.trajectory_->getLastWayPoint().getGlobalLinkTransform("body");
  EXPECT_LT((end.translation() - Eigen::Vector3d(2.5, 1.0, 1.0)).norm(), 1e-2);
  EXPECT_GT(std::abs(end.linear()(1, 0)), 1.0 - 1e-3);
}

TEST_F(Drone, StaysInTheWorkspace)
{
  const Eigen::Vector4d upright(0.0, 0.0, 0.0, 1.0);
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), planTo({0.0, 0.0, 2.9}, upright));
  EXPECT_EQ(int(MoveItErrorCodes::GOAL_STATE_INVALID), planTo({0.0, 0.0, 3.1}, upright));
}

TEST_F(Drone, RefusesRotationsThatAreNone)
{
  const Eigen::Vector3d place(1.0, 0.0, 0.0);
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), planTo(place, {0.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), planTo(place, {0.0, 0.0, 0.0, 1.1}));
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), planTo(place, {0.0, 0.0, 0.0, 1.0005}));
  request_.goal_constraints[0].joint_constraints.pop_back();
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS), plan()) << "a part of a rotation";
}
}  // namespace
}  // namespace gpu_planning_scene::pipeline
