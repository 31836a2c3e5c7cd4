#include "literature/libraries/library_methods.h"

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

std::vector<std::string> missingLibraryMethods()
{
  std::vector<std::string> lines;
#ifdef GPS_LITERATURE_EMBREE
  if (const std::string reason = whyNoEmbree(); !reason.empty())
    lines.push_back("embree is left out: " + reason);
#endif
#ifdef GPS_LITERATURE_CGAL
  if (const std::string reason = whyNoCgal(); !reason.empty())
    lines.push_back("cgal is left out: " + reason);
#endif
  return lines;
}
}  // namespace gpu_planning_scene::core::literature
