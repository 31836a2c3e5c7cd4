#include "collision/problem/padding.h"

#include <cstddef>

// A link and an object collide if their distance is at most the sum of their paddings (README.md, "What collision
// means").
namespace gpu_planning_scene::core
{
double paddingOf(const PlanningScene& scene, int link)
{
  return scene.link_padding.empty() ? 0.0 : scene.link_padding[static_cast<std::size_t>(link)];
}

double paddingOf(const PlanningScene& scene, const AttachedObject& attached)
{
  return paddingOf(scene, attached.link) + attached.padding;
}
}  // namespace gpu_planning_scene::core
