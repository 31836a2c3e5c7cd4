#pragma once

#include "literature/method.h"

/// The only symbol of the library with Embree, which is opened at run time. The caller owns the method. Throws Error if
/// Embree cannot build its trees.
extern "C" __attribute__((visibility("default"))) gpu_planning_scene::core::literature::Method* gpsMakeEmbree(
    const gpu_planning_scene::core::Mesh& a, const gpu_planning_scene::core::Mesh& b);
