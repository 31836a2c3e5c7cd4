#pragma once

#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// The change from the store's scene to the scene that `full` makes: equal parts are left out, so that they keep their
/// trees. Measured variables, and those that already have their value, are left out too. Throws the errors of `full`.
SceneChange differenceTo(SceneChange full, const SceneStore& store, const SceneStore::Lookup& lookup);
}  // namespace gpu_planning_scene::core
