#include "node/messages/joint_transform.h"

#include "gpu_planning_scene/error.h"
#include "node/messages/object_from_message.h"
#include "scene/message_values.h"

namespace gpu_planning_scene::core
{
std::vector<double> variablesOfTransform(const RobotModel& robot, const Joint& joint, const std::string& frame,
                                         const geometry_msgs::Transform& transform, const std::string& where)
{
  if (joint.type != JointType::Planar && joint.type != JointType::Floating)
    throw Error(where + ": the joint is neither planar nor floating; give its position in the list of joint positions");
  const std::string& parent =
      joint.parent_link < 0 ? robot.planningFrame() : robot.links()[static_cast<std::size_t>(joint.parent_link)].name;
  if (!frame.empty() && frame != robot.planningFrame() && frame != parent)
    throw Error(where + " is given in frame '" + frame + "'; it must be the planning frame '" + robot.planningFrame() +
                "' or the joint's parent '" + parent + "'");
  const Eigen::Isometry3d pose = isometryOf(transform.translation, transform.rotation);
  if (!pose.matrix().allFinite())
    throw Error(where + " is not finite");
  return variablesAt(joint, pose);
}
}  // namespace gpu_planning_scene::core
