#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "model/srdf_reader.h"
#include "model/urdf_reader.h"

namespace gpu_planning_scene::core
{
/// The kinematic tree of a robot, its links and joints depth first, siblings in the order of their joints' names: the
/// order that MoveIt has.
struct RobotTree
{
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<Variable> variables;
};

/// `virtual_joint` (null where there is none) moves the root link. Loads the meshes. Throws Error.
RobotTree buildTree(const UrdfText& urdf, const SrdfVirtualJoint* virtual_joint, const RobotModelOptions& options,
                    std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
