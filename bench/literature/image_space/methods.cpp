#include "literature/image_space/cinder.h"
#include "literature/image_space/cullide.h"
#include "literature/image_space/fattened_cullide.h"
#include "literature/image_space/recode.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using ScopeOf = Scope (*)(int resolution, int views);

/// The run is full enough with all resolutions in one view, and with all views at two resolutions.
Scope usualScope(int resolution, int views)
{
  if (resolution == 64 && views == 1)
    return Scope::Always;
  return views == 1 || resolution == 64 || resolution == 256 ? Scope::FullRun : Scope::Named;
}

/// Fattened triangles take most of the time, and miss nothing at any resolution.
Scope slowScope(int resolution, int views)
{
  if (resolution == 64 && views == 1)
    return Scope::Always;
  return resolution == 256 && views == 1 ? Scope::FullRun : Scope::Named;
}

template <class Drawn>
void append(std::vector<MethodInfo>& methods, const std::string& name, const std::string& title,
            const std::string& source, const Domain& domain, ScopeOf scope,
            const std::vector<int>& view_counts = {1, 3})
{
  for (const int resolution : {64, 128, 256, 512})
    for (const int views : view_counts)
    {
      ImageOptions options;
      options.resolution = resolution;
      options.views = views;
      const std::string side = std::to_string(resolution);
      methods.push_back({name + "_" + side + "x" + std::to_string(views),
                         title + ", " + side + " x " + side + " pixels, " +
                             (views == 1 ? "1 view" : std::to_string(views) + " views"),
                         source, "image space", domain,
                         [options](const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b)
                         { return std::make_unique<Drawn>(a, b, options); },
                         scope(resolution, views)});
    }
}
}  // namespace

std::vector<MethodInfo> imageSpaceMethods()
{
  Domain convex_solids;
  convex_solids.concave = false;
  convex_solids.open = false;
  convex_solids.containment = true;
  Domain solids;
  solids.open = false;
  solids.containment = true;
  std::vector<MethodInfo> methods;
  append<Recode>(methods, "recode", "RECODE", "Baciu, Wong, Sun 1999", convex_solids, usualScope);
  append<Cinder>(methods, "cinder", "CInDeR", "Knott, Pai 2003", solids, usualScope);
  append<Cullide>(methods, "cullide", "CULLIDE", "Govindaraju, Redon, Lin, Manocha 2003", {}, usualScope, {1, 2, 3});
  append<FattenedCullide>(methods, "cullide_fattened", "CULLIDE, fattened", "Govindaraju, Lin, Manocha 2004", {},
                          slowScope);
  return methods;
}
}  // namespace gpu_planning_scene::core::literature
