#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "model/description/srdf_reader.h"
#include "model/description/urdf_reader.h"

namespace gpu_planning_scene::core
{
/// The kinematic tree of a robot. Links and joints are in depth-first order, siblings in the order of their joints'
/// names, as in MoveIt.
struct RobotTree
{
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<Variable> variables;
  std::vector<int> widened;  ///< the variables that have wider limits than in the URDF
};

/// Sets Variable::largest so that no joint, also no mimic joint, moves by more than kLargestLength, and no angle
/// overflows.
void limitVariables(RobotTree& tree);

/// Builds the tree and loads the meshes. `virtual_joint` moves the root link; null if there is none. Throws Error.
RobotTree buildTree(const UrdfText& urdf, const SrdfVirtualJoint* virtual_joint, const RobotModelOptions& options,
                    std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
