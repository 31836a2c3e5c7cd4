#include "node/messages/joint_transform.h"

#include "gpu_planning_scene/error.h"
#include "node/messages/object_from_message.h"
#include "scene/frame.h"
#include "scene/message_values.h"

namespace gpu_planning_scene::core
{
std::vector<double> variablesOfTransform(const RobotModel& robot, const Joint& joint, const std::string& frame,
                                         const geometry_msgs::Transform& transform, const std::string& where)
{
  if (joint.type != JointType::Planar && joint.type != JointType::Floating)
    throw Error(where + ": the joint is neither planar nor floating; give its position in the list of joint positions");
  if (!frame.empty() && !isPlanningFrame(robot, frame))
    throw Error(where + " is given in frame '" + frame + "'; it must be the planning frame '" + robot.planningFrame() +
                "' or empty, because the transform is the motion of the joint from its origin");
  const Eigen::Isometry3d pose = isometryOf(transform.translation, transform.rotation);
  if (!pose.matrix().allFinite())
    throw Error(where + " is not finite");
  return variablesAt(joint, pose);
}
}  // namespace gpu_planning_scene::core
