#include "node/moveit/mimic_joints.h"

#include <cmath>

namespace gpu_planning_scene::core
{
namespace
{
bool isMimicJoint(const std::string& name, const RobotModel& robot)
{
  const int joint = robot.jointIndex(name);
  return joint >= 0 && robot.joints()[static_cast<std::size_t>(joint)].mimic;
}
}  // namespace

PlanningSceneMessage withoutMimicJoints(PlanningSceneMessage scene, const RobotModel& robot)
{
  sensor_msgs::JointState& joints = scene.robot_state.joint_state;
  if (joints.position.size() != joints.name.size())
    return scene;  // the conversion of the message reports this
  std::size_t kept = 0;
  for (std::size_t i = 0; i < joints.name.size(); ++i)
    if (!isMimicJoint(joints.name[i], robot))
    {
      joints.name[kept] = joints.name[i];
      joints.position[kept++] = joints.position[i];
    }
  joints.name.resize(kept);
  joints.position.resize(kept);
  return scene;
}

std::string mimicFault(const PlanningSceneMessage& scene, const RobotModel& robot, const std::vector<double>& state)
{
  constexpr double kTolerance = 1e-3;
  const sensor_msgs::JointState& joints = scene.robot_state.joint_state;
  if (joints.position.size() != joints.name.size())
    return "";  // the conversion of the message reports this
  std::vector<double> values = state;
  for (std::size_t i = 0; i < joints.name.size(); ++i)
    if (const int variable = robot.variableIndex(joints.name[i]); variable >= 0)
      values[static_cast<std::size_t>(variable)] = joints.position[i];
  for (std::size_t i = 0; i < joints.name.size(); ++i)
  {
    if (!isMimicJoint(joints.name[i], robot))
      continue;
    const Joint& joint = robot.joints()[static_cast<std::size_t>(robot.jointIndex(joints.name[i]))];
    const auto leader = static_cast<std::size_t>(joint.first_variable);
    const double position = joint.multiplier * values[leader] + joint.offset;
    if (!(std::abs(joints.position[i] - position) <= kTolerance))
      return "joint '" + joint.name + "' follows '" + robot.variables()[leader].name + "', which gives it the value " +
             std::to_string(position) + " and not " + std::to_string(joints.position[i]) +
             "; a joint cannot be checked away from the joint that it follows";
  }
  return "";
}
}  // namespace gpu_planning_scene::core
