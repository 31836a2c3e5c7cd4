#include "scene/changes/matrix_entries.h"

#include <algorithm>
#include <cstddef>

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

std::vector<std::string> warningsOfMatrix(const RobotModel& robot, const AllowedCollisionMatrix& matrix)
{
  std::vector<std::string> warnings;
  if (!matrix.bodies().empty() && matrix.bodiesWithEntries().empty() &&
      !AllowedCollisionMatrix::fromRobot(robot).bodiesWithEntries().empty())
    warnings.push_back(std::string("allowed_collision_matrix: it has only default entries, so the pairs that ") +
                       (robot.srdfCollisions().has_srdf ? "the SRDF allows" : "are adjacent") +
                       " are checked too (as in MoveIt); give entry_names and entry_values for them");
  const auto name = [&robot](int link) { return robot.links()[static_cast<std::size_t>(link)].name; };
  const std::vector<LinkPair>& unproven = robot.srdfCollisions().unproven;
  const auto count =
      std::count_if(unproven.begin(), unproven.end(),
                    [&](const LinkPair& pair) { return matrix.allowed(name(pair.first), name(pair.second)); });
  if (count != 0)
    warnings.push_back("allowed_collision_matrix: it allows " + std::to_string(count) +
                       " pairs with the reason Never, so they are not checked, although limits are wider than those " +
                       "of their proof; run generate_acm with these limits for the SRDF of all nodes");
  return warnings;
}
}  // namespace gpu_planning_scene::core
