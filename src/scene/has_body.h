#pragma once

#include <string>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Whether a link, an object or an attached object has this name.
inline bool hasBody(const PlanningScene& scene, const std::string& name)
{
  const std::size_t bodies = scene.robot->links().size() + scene.objects.size() + scene.attached.size();
  for (std::size_t i = 0; i < bodies; ++i)
    if (scene.bodyName(static_cast<int>(i)) == name)
      return true;
  return false;
}
}  // namespace gpu_planning_scene::core
