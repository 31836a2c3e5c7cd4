#include "literature/libraries/fcl_methods.h"
#include "literature/libraries/gimpact.h"
#include "literature/method.h"
#ifdef GPS_LITERATURE_OPCODE
#include "literature/libraries/opcode.h"
#endif
#ifdef GPS_LITERATURE_CGAL
#include "literature/cgal/cgal_method.h"
#endif
#ifdef GPS_LITERATURE_EMBREE
#include "literature/libraries/embree.h"
#endif

namespace gpu_planning_scene::core::literature
{
std::vector<MethodInfo> libraryMethods()
{
  std::vector<MethodInfo> methods = fclMethods();
  const auto add = [&](const std::vector<MethodInfo>& others)
  { methods.insert(methods.end(), others.begin(), others.end()); };
#ifdef GPS_LITERATURE_OPCODE
  add(opcodeMethods());
#endif
  add(gimpactMethods());
#ifdef GPS_LITERATURE_EMBREE
  add(embreeMethods());
#endif
#ifdef GPS_LITERATURE_CGAL
  add(cgalMethods());
#endif
  return methods;
}
}  // namespace gpu_planning_scene::core::literature
