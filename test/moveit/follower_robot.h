#pragma once

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include <moveit/robot_state/robot_state.h>
#include <srdfdom/model.h>
#include <urdf_parser/urdf_parser.h>

namespace gpu_planning_scene
{
inline moveit::core::RobotModelPtr robotFromUrdf(const std::string& links_and_joints, const std::string& srdf_elements)
{
  const urdf::ModelInterfaceSharedPtr urdf = urdf::parseURDF("<robot name='robot'>" + links_and_joints + "</robot>");
  const auto srdf = std::make_shared<srdf::Model>();
  if (!urdf || !srdf->initString(*urdf, "<robot name='robot'>" + srdf_elements + "</robot>"))
    throw std::runtime_error("the robot of the test is not valid");
  return std::make_shared<moveit::core::RobotModel>(urdf, srdf);
}

/// A joint and its child link, in URDF. `place`: of the joint in its parent. `rest`: further elements of the joint.
inline std::string jointWithLink(const std::string& joint, const std::string& type, const std::string& parent,
                                 const std::string& child, const std::string& place, const std::string& axis,
                                 const std::string& rest)
{
  return "<link name='" + child + "'><collision><origin xyz='0.2 0 0'/><geometry><box size='0.2 0.06 0.06'/>" +
         "</geometry></collision></link><joint name='" + joint + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + place + "'/><axis xyz='" + axis + "'/>" + rest + "</joint>";
}

/// Leaders and followers (mimic joints) of all kinds, each on a branch of its own, so that no other joint moves the
/// follower's link:
///   - `turn`, without limits: followed by a joint that turns and by one that slides
///   - `slide`: followed by one that slides farther, by one that turns, and by one that begins 1 m away from its parent
inline moveit::core::RobotModelPtr followerRobot(const std::string& srdf_elements = "")
{
  const std::string limits = "<limit lower='-0.5' upper='0.5' effort='1' velocity='1'/>";
  const std::string wide = "<limit lower='-9' upper='9' effort='1' velocity='1'/>";
  return robotFromUrdf("<link name='base'/>" +
                           jointWithLink("turn", "continuous", "base", "turner", "0 0 0", "0 0 1", "") +
                           jointWithLink("turn_back", "revolute", "base", "back_turner", "0 0 0.4", "0 0 1",
                                         wide + "<mimic joint='turn' multiplier='-1.5' offset='0.3'/>") +
                           jointWithLink("lift", "prismatic", "base", "lifted", "0.8 0 0", "0 0 1",
                                         wide + "<mimic joint='turn' multiplier='0.3'/>") +
                           jointWithLink("slide", "prismatic", "base", "slider", "0 -0.5 0", "1 0 0", limits) +
                           jointWithLink("slide_farther", "prismatic", "base", "far_slider", "0 -0.9 0", "1 0 0",
                                         wide + "<mimic joint='slide' multiplier='-2' offset='0.1'/>") +
                           jointWithLink("roll", "revolute", "base", "wheel", "0 0.8 0", "0 0 1",
                                         wide + "<mimic joint='slide' multiplier='3'/>") +
                           jointWithLink("swing", "revolute", "base", "swinger", "0 0 -0.4", "0 0 1", wide) +
                           jointWithLink("telescope", "prismatic", "swinger", "tip", "0 0 0", "1 0 0",
                                         wide + "<mimic joint='slide' multiplier='0.1' offset='1'/>"),
                       srdf_elements);
}

/// Whether a leader without limits turns by more than half a turn. MoveIt then lets its value, and those of its
/// followers, jump by a whole turn.
inline bool followersJump(const moveit::core::RobotState& from, const moveit::core::RobotState& to)
{
  for (const moveit::core::JointModel* joint : from.getRobotModel()->getActiveJointModels())
    if (!joint->getMimicRequests().empty() && joint->getVariableCount() == 1 &&
        !joint->getVariableBounds()[0].position_bounded_ &&
        !(std::abs(*to.getJointPositions(joint) - *from.getJointPositions(joint)) <= M_PI))
      return true;
  return false;
}
}  // namespace gpu_planning_scene
