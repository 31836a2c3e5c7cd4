#include "literature/libraries/fcl_methods.h"
#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
std::vector<MethodInfo> libraryMethods()
{
  return fclMethods();
}
}  // namespace gpu_planning_scene::core::literature
