#pragma once

#include <string>
#include <vector>

#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Makes these cubes (in the planning frame) the world object `id`, in the place of its earlier cubes. Without cubes,
/// there is no such object. Entries of `id` in the allowed collision matrix stay. Nothing is changed, and the revision
/// stays, if the object already has these cubes. If it throws Error, nothing has changed.
void replaceObject(SceneStore& store, const std::string& id, std::vector<PlacedShape> cubes);
}  // namespace gpu_planning_scene::core
