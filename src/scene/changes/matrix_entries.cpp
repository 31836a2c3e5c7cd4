#include "scene/changes/matrix_entries.h"

namespace gpu_planning_scene::core
{
std::vector<std::string> removeEntriesOfObject(AllowedCollisionMatrix& matrix, const std::string& id)
{
  std::vector<std::string> warnings;
  for (const std::string& other : matrix.removeEntry(id))
    warnings.push_back("object '" + id + "' was removed together with the matrix entry that forbids contact with '" +
                       other + "'; a new object of this name may touch '" + other +
                       "', whose default in the matrix allows it");
  return warnings;
}

std::string warningOfDefaultsAlone(const RobotModel& robot, const AllowedCollisionMatrix& matrix)
{
  if (matrix.bodies().empty() || !matrix.bodiesWithEntries().empty() ||
      AllowedCollisionMatrix::fromRobot(robot).bodiesWithEntries().empty())
    return "";
  return std::string("allowed_collision_matrix: it has only default entries, so the pairs that ") +
         (robot.srdfCollisions().has_srdf ? "the SRDF allows" : "are adjacent") +
         " are checked too (as in MoveIt); give entry_names and entry_values for them";
}
}  // namespace gpu_planning_scene::core
