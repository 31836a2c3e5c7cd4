#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "model/description/tree_builder.h"

namespace gpu_planning_scene::core
{
/// The parts of a robot that another program has read from a URDF and an SRDF. The members are those of RobotModel.
struct RobotParts
{
  std::string name;
  std::string planning_frame;
  RobotTree tree;  ///< Variable::largest is set by makeRobot
  std::vector<Group> groups;
};

/// Makes a robot without collision entries and named states of an SRDF. The caller ensures that names are unique, that
/// parents come before children, and that all indices and values are valid.
std::shared_ptr<const RobotModel> makeRobot(RobotParts parts);
}  // namespace gpu_planning_scene::core
