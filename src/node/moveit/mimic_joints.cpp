#include "node/moveit/mimic_joints.h"

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
}  // namespace gpu_planning_scene::core
