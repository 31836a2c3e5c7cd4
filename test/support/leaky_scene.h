#pragma once

#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
/// "kr5" with objects that are meshes with the damages of real files, in turn.
TestScene leakyScene();
}  // namespace gpu_planning_scene::core
