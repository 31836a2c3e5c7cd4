#pragma once

#include <cstddef>

#include "benchmark/method.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::benchmark
{
/// How long it takes until a check of one state knows that one object was moved, without the time of the check itself
/// and of copying the scene: the median of `repeats`. Not a number for a method that has to be built anew, or a scene
/// without objects.
double secondsOfUpdate(Method& method, const TestScene& scene, std::size_t repeats);
}  // namespace gpu_planning_scene::benchmark
