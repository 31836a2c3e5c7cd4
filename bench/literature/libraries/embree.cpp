#include "literature/libraries/embree.h"

#include <cstring>

#include <dlfcn.h>

#include "literature/libraries/embree_library.h"

// Embree takes 44 MB, so a library of its own contains the calls of Embree, and is opened at run time. Programs can be
// copied without it.
namespace gpu_planning_scene::core::literature
{
namespace
{
struct Loaded
{
  decltype(&gpsMakeEmbree) make = nullptr;
  std::string missing;
};

Loaded load()
{
  void* const opened = dlopen(GPS_LITERATURE_EMBREE, RTLD_NOW | RTLD_LOCAL);
  void* const symbol = opened != nullptr ? dlsym(opened, "gpsMakeEmbree") : nullptr;
  if (symbol == nullptr)
    return {nullptr, "cannot open the library with Embree: " + std::string(dlerror())};
  Loaded loaded;
  std::memcpy(&loaded.make, &symbol, sizeof(loaded.make));
  return loaded;
}

const Loaded& loaded()
{
  static const Loaded once = load();
  return once;
}
}  // namespace

std::string whyNoEmbree()
{
  return loaded().missing;
}

std::vector<MethodInfo> embreeMethods()
{
  const auto make = loaded().make;
  if (make == nullptr)
    return {};
  return {
      {"embree", "Embree, refitted", "Wald et al. 2014; Embree 3", "library", {}, [make](const auto& a, const auto& b) {
         return std::unique_ptr<Method>(make(*a, *b));
       }}};
}
}  // namespace gpu_planning_scene::core::literature
