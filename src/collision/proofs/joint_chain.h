#pragma once

#include <optional>
#include <vector>

#include "collision/proofs/joint_table.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A joint on the path between two links.
struct ChainJoint
{
  const Joint* joint;
  bool upwards;  ///< the path goes from the joint's child to its parent
};

/// The joints on the path from one link to another in the kinematic tree, with fixed joints.
std::vector<ChainJoint> jointsBetween(const RobotModel& robot, int from, int to);

/// The variables that move the joints of a chain, each once and as a single cell. No value if a joint is planar or
/// floating, or if a variable has no limits and is not that of continuous joints.
std::optional<std::vector<TableVariable>> chainVariables(const RobotModel& robot, const std::vector<ChainJoint>& chain);

/// The variables of a joint table for two links with these joints between them, in the order of the joints. No value if
/// there is no such table: see makeJointTable.
std::optional<std::vector<TableVariable>> tableVariables(const RobotModel& robot, const std::vector<ChainJoint>& chain);
}  // namespace gpu_planning_scene::core
