// MoveIt's services compute_ik, compute_fk and compute_cartesian_path, judged by MoveIt's own kinematics and FCL.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <moveit/planning_scene/planning_scene.h>
#include <moveit_msgs/GetCartesianPath.h>
#include <moveit_msgs/GetPositionFK.h>
#include <moveit_msgs/GetPositionIK.h>
#include <moveit_msgs/MoveItErrorCodes.h>

#include "node/child_node.h"
#include "node/messages/pose_messages.h"
#include "node/moveit/moveit_client.h"
#include "node/persistent_call.h"

namespace gpu_planning_scene::core
{
namespace
{
using moveit::core::RobotState;
using moveit_msgs::MoveItErrorCodes;

constexpr char kArm[] = "panda_arm";
constexpr char kTip[] = "panda_link8";

class MoveItKinematicsOverRos : public testing::Test
{
 protected:
  static void SetUpTestSuite()
  {
    model = moveItPanda();
    node = std::make_unique<ChildNode>("kinematics", std::vector<std::string>{"_device:=cpu", "_moveit_names:=true"});
  }
  static void TearDownTestSuite()
  {
    node.reset();
    model.reset();
  }

  static RobotState ready()
  {
    RobotState state(model);
    state.setToDefaultValues();
    state.setToDefaultValues(model->getJointModelGroup(kArm), "ready");
    state.update();
    return state;
  }

  static moveit_msgs::RobotState messageOf(const RobotState& state)
  {
    moveit_msgs::RobotState message;
    for (const std::string& name : state.getVariableNames())
      if (name.find('/') == std::string::npos)
      {
        message.joint_state.name.push_back(name);
        message.joint_state.position.push_back(state.getVariablePosition(name));
      }
    message.is_diff = true;
    return message;
  }

  /// The state of a response: the ready state with its joints.
  static RobotState stateOf(const sensor_msgs::JointState& joints)
  {
    RobotState state = ready();
    for (std::size_t i = 0; i < joints.name.size(); ++i)
      state.setVariablePosition(joints.name[i], joints.position[i]);
    state.update();
    return state;
  }

  static moveit_msgs::GetPositionIK ikFor(const Eigen::Isometry3d& pose)
  {
    moveit_msgs::GetPositionIK call;
    call.request.ik_request.group_name = kArm;
    call.request.ik_request.robot_state = messageOf(ready());
    call.request.ik_request.avoid_collisions = 1;
    call.request.ik_request.pose_stamped.pose = poseOf(pose);
    return call;
  }

  static moveit_msgs::GetCartesianPath linesTo(const std::vector<Eigen::Isometry3d>& poses)
  {
    moveit_msgs::GetCartesianPath call;
    call.request.group_name = kArm;
    call.request.start_state = messageOf(ready());
    call.request.max_step = 0.01;
    call.request.avoid_collisions = 1;
    for (const Eigen::Isometry3d& pose : poses)
      call.request.waypoints.push_back(poseOf(pose));
    return call;
  }

  template <class Call>
  static int codeOf(Call& call, const std::string& service)
  {
    EXPECT_TRUE(callPersistently(service, call));
    return call.response.error_code.val;
  }

  static inline moveit::core::RobotModelPtr model;
  static inline std::unique_ptr<ChildNode> node;
};

TEST_F(MoveItKinematicsOverRos, ForwardKinematicsAreMoveIts)
{
  moveit_msgs::GetPositionFK call;
  call.request.fk_link_names = {kTip, "panda_hand"};
  call.request.robot_state = messageOf(ready());
  call.request.header.frame_id = "panda_link1";
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), codeOf(call, "/compute_fk"));
  ASSERT_EQ(2U, call.response.pose_stamped.size());
  const Eigen::Isometry3d base = ready().getGlobalLinkTransform("panda_link1");
  for (std::size_t i = 0; i < 2; ++i)
  {
    const geometry_msgs::Pose expected =
        poseOf(base.inverse() * ready().getGlobalLinkTransform(call.request.fk_link_names[i]));
    EXPECT_NEAR(expected.position.x, call.response.pose_stamped[i].pose.position.x, 1e-9);
    EXPECT_NEAR(expected.position.z, call.response.pose_stamped[i].pose.position.z, 1e-9);
    EXPECT_EQ("panda_link1", call.response.pose_stamped[i].header.frame_id);
  }
  call.request.fk_link_names = {"elbow"};
  EXPECT_EQ(int(MoveItErrorCodes::FAILURE), codeOf(call, "/compute_fk"));
}

TEST_F(MoveItKinematicsOverRos, InverseKinematicsReachPosesOfRandomFreeStates)
{
  planning_scene::PlanningScene scene(model);
  RobotState random = ready();
  for (int i = 0; i < 50;)
  {
    random.setToRandomPositions(model->getJointModelGroup(kArm));
    random.update();
    if (scene.isStateColliding(random, kArm))
      continue;
    ++i;
    const Eigen::Isometry3d pose = random.getGlobalLinkTransform(kTip);
    moveit_msgs::GetPositionIK call = ikFor(pose);
    ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), codeOf(call, "/compute_ik"));
    const RobotState found = stateOf(call.response.solution.joint_state);
    EXPECT_TRUE(found.getGlobalLinkTransform(kTip).isApprox(pose, 1e-5));
    EXPECT_TRUE(found.satisfiesBounds(model->getJointModelGroup(kArm)));
    EXPECT_FALSE(scene.isStateColliding(found, kArm));
  }
}

TEST_F(MoveItKinematicsOverRos, PosesThatCannotBeReachedHaveMoveItsErrorCode)
{
  Eigen::Isometry3d far = ready().getGlobalLinkTransform(kTip);
  far.translation().x() += 5.0;
  moveit_msgs::GetPositionIK call = ikFor(far);
  EXPECT_EQ(int(MoveItErrorCodes::NO_IK_SOLUTION), codeOf(call, "/compute_ik"));
  call.request.ik_request.group_name = "leg";
  EXPECT_EQ(int(MoveItErrorCodes::INVALID_GROUP_NAME), codeOf(call, "/compute_ik"));
  call = ikFor(far);
  call.request.ik_request.constraints.joint_constraints.resize(1);
  EXPECT_EQ(int(MoveItErrorCodes::FAILURE), codeOf(call, "/compute_ik"));
}

TEST_F(MoveItKinematicsOverRos, ACartesianPathKeepsToItsLineAndHasTimes)
{
  const Eigen::Isometry3d begin = ready().getGlobalLinkTransform(kTip);
  Eigen::Isometry3d end = begin;
  end.translation().z() -= 0.15;
  moveit_msgs::GetCartesianPath call = linesTo({end});
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), codeOf(call, "/compute_cartesian_path"));
  EXPECT_EQ(1.0, call.response.fraction);
  const trajectory_msgs::JointTrajectory& path = call.response.solution.joint_trajectory;
  ASSERT_LT(10U, path.points.size());
  planning_scene::PlanningScene scene(model);
  double before = -1.0;
  for (const trajectory_msgs::JointTrajectoryPoint& point : path.points)
  {
    sensor_msgs::JointState joints;
    joints.name = path.joint_names;
    joints.position = point.positions;
    const RobotState state = stateOf(joints);
    const Eigen::Vector3d tip = state.getGlobalLinkTransform(kTip).translation();
    EXPECT_NEAR(begin.translation().x(), tip.x(), 3e-4);
    EXPECT_NEAR(begin.translation().y(), tip.y(), 3e-4);
    EXPECT_FALSE(scene.isStateColliding(state, kArm));
    EXPECT_LT(before, point.time_from_start.toSec());
    before = point.time_from_start.toSec();
  }
  sensor_msgs::JointState last;
  last.name = path.joint_names;
  last.position = path.points.back().positions;
  EXPECT_TRUE(stateOf(last).getGlobalLinkTransform(kTip).isApprox(end, 1e-4));
}

TEST_F(MoveItKinematicsOverRos, ACartesianPathOutOfReachEndsEarly)
{
  Eigen::Isometry3d end = ready().getGlobalLinkTransform(kTip);
  end.translation().x() += 2.0;
  moveit_msgs::GetCartesianPath call = linesTo({end});
  ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), codeOf(call, "/compute_cartesian_path"));
  EXPECT_LT(0.0, call.response.fraction);
  EXPECT_GT(0.5, call.response.fraction);
  call.request.max_step = 0.0;
  EXPECT_EQ(int(MoveItErrorCodes::FAILURE), codeOf(call, "/compute_cartesian_path"));
}
}  // namespace
}  // namespace gpu_planning_scene::core
