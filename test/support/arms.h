#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A real robot with a group that moves an arm.
struct Arm
{
  std::string name;
  std::shared_ptr<const RobotModel> robot;
  std::string group;
  std::string urdf;  ///< text
  std::string root;  ///< the link at which the group's chain begins; empty if the base moves too
};

/// The arms of panda, ur5, kr5 and PR2, and panda on a planar base; those whose files exist. They are loaded
/// once per process.
const std::vector<Arm>& realArms();
}  // namespace gpu_planning_scene::core
