#pragma once

#include <cstddef>
#include <cstdint>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The link that a body (an index as in PlanningScene) moves with; -1: an object of the world.
inline int linkOfBody(const PlanningScene& scene, std::int32_t body)
{
  const auto links = static_cast<std::int32_t>(scene.robot->links().size());
  const auto objects = static_cast<std::int32_t>(scene.objects.size());
  if (body < links)
    return body;
  return body < links + objects ? -1 : scene.attached[static_cast<std::size_t>(body - links - objects)].link;
}
}  // namespace gpu_planning_scene::core
