#pragma once

#include <cstddef>

#include "benchmark/method.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::benchmark
{
/// How long it takes from giving a method a scene in which one object was moved to its answer about one state in that
/// scene; copying the scene is not counted. The median of `repeats`, after one that is not. Not a number for a method
/// that has to be built anew, or a scene without objects.
double secondsOfUpdate(Method& method, const TestScene& scene, std::size_t repeats);
}  // namespace gpu_planning_scene::benchmark
