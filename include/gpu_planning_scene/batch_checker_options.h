#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
enum class Traversal
{
  BreadthFirst,  ///< packed work lists, level by level (Gress and Zachmann 2003)
  WorkQueue      ///< a node stack per lane and a leaf queue per workgroup
};

/// "breadth_first" or "work_queue"; throws Error otherwise.
Traversal traversalFromName(const std::string& name);

struct BatchCheckerOptions : CheckerOptions
{
  /// "auto" (the first hardware device, else software), "software", an index, or part of a renderer's name.
  std::string device = "auto";
  Traversal traversal = Traversal::WorkQueue;
  std::size_t max_batch = 16384;  ///< states that go to the GPU at once; larger requests are split
  /// Batches of fewer states go to the CPU; 0: never. Unset: measured for each scene, whichever is faster.
  std::optional<std::size_t> cpu_below;
  std::string shader_folder;  ///< empty: where they were installed, or the source tree's (see shaderFolder())
};

/// What the GPU looked at, over all states.
struct GpuWork
{
  std::size_t states = 0;      ///< that went to it
  std::size_t candidates = 0;  ///< pairs of instances, by state, whose spheres or outer boxes overlap
  std::size_t root_pairs = 0;  ///< of them, those whose root boxes overlap: these are traversed
};
}  // namespace gpu_planning_scene::core
