#include "moveit/planner/pose_constraints.h"

#include <algorithm>

#include "moveit/planner/joint_goals.h"
#include "moveit/planner/refusal.h"
#include "scene/constraints_from_message.h"

namespace gpu_planning_scene::pipeline
{
namespace
{
using moveit::core::JointModelGroup;
using moveit::core::LinkModel;
using moveit::core::RobotState;

/// A frame of the robot: the link that carries it, and its pose in the link's frame. A null link: not of the robot.
struct RobotFrame
{
  const LinkModel* link = nullptr;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

RobotFrame robotFrame(const RobotState& state, const std::string& name)
{
  RobotFrame frame;
  bool is_found = false;
  const Eigen::Isometry3d& pose = state.getFrameInfo(name, frame.link, is_found);
  if (!is_found || !frame.link)
    return {};
  frame.pose = state.getGlobalLinkTransform(frame.link).inverse() * pose;
  return frame;
}

bool moves(const JointModelGroup& group, const LinkModel& link)
{
  const std::vector<const LinkModel*>& links = group.getUpdatedLinkModels();
  return std::find(links.begin(), links.end(), &link) != links.end();
}

Eigen::Isometry3d standingFrame(const std::string& name, const planning_scene::PlanningScene& scene,
                                const RobotState& start, const JointModelGroup& group)
{
  if (name.empty() || moveit::core::Transforms::sameFrame(name, scene.getPlanningFrame()))
    return Eigen::Isometry3d::Identity();
  if (const RobotFrame frame = robotFrame(start, name); frame.link && moves(group, *frame.link))
    throw Refusal(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE,
                  "the frame '" + name + "' moves with group '" + group.getName() +
                      "'; give the constraint in a frame that stands still during the motion");
  if (!scene.knowsFrameTransform(start, name))
    throw Refusal(MoveItErrorCodes::FRAME_TRANSFORM_FAILURE, "the scene does not know the frame '" + name + "'");
  return scene.getFrameTransform(start, name);
}

core::LinkFrame linkFrame(const std::string& name, const RobotState& start)
{
  const RobotFrame frame = robotFrame(start, name);
  if (!frame.link)
    throw Refusal(MoveItErrorCodes::INVALID_LINK_NAME,
                  "the robot has no link '" + name + "' and carries no object of this name");
  return {RobotConversion::link(*frame.link), frame.pose};
}
}  // namespace

core::KinematicConstraints kinematicConstraints(const moveit_msgs::Constraints& message,
                                                const planning_scene::PlanningScene& scene, const RobotState& start,
                                                const JointModelGroup& group, const RobotConversion& robot,
                                                std::int32_t code, const std::string& where)
{
  if (!message.visibility_constraints.empty())
    throw Refusal(code, where + ": visibility constraints are not planned for; use another pipeline");
  const core::ConstraintFrames frames{[&](const core::StampedFrame& frame)
                                      { return standingFrame(frame.name, scene, start, group); },
                                      [&](const std::string& name) { return linkFrame(name, start); }};
  moveit_msgs::Constraints poses = message;
  poses.joint_constraints.clear();  // they name MoveIt's variables
  try
  {
    core::KinematicConstraints constraints = core::constraintsFrom(poses, *robot.robot(), frames, where);
    try
    {
      addJointRanges(message, *start.getRobotModel(), robot, constraints);
    }
    catch (const Refusal& refusal)
    {
      throw Refusal(code, where + ": " + refusal.what());
    }
    constraints.validate(*robot.robot(), where);
    return constraints;
  }
  catch (const Refusal&)
  {
    throw;
  }
  catch (const core::Error& error)
  {
    throw Refusal(code, error.what());
  }
}
}  // namespace gpu_planning_scene::pipeline
