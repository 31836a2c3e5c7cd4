#include "scene/matrix_entries.h"

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
}  // namespace gpu_planning_scene::core
