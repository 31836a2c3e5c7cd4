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
  WorkQueue      ///< a node stack per invocation and a leaf queue per work group
};

/// Reads "breadth_first" or "work_queue". Throws Error for any other name.
Traversal traversalFromName(const std::string& name);

struct BatchCheckerOptions : CheckerOptions
{
  /// "auto" (the first hardware device, or software if there is none), "software", an index (Device::index), or a part
  /// of a renderer's name. The node, the tools and Python also take several devices ("0+1") and all hardware devices
  /// ("all").
  std::string device = "auto";
  Traversal traversal = Traversal::WorkQueue;
  /// The most states that go to the GPU at once. Larger requests are split. The checker sends fewer if so many would
  /// take the GPU more than 50 ms, overflow its lists, or exceed its largest buffer texture. 131,072 states need about
  /// 350 MB of the GPU's memory (420 MB with Traversal::BreadthFirst), plus 64 bytes for each shape of the robot in
  /// each state.
  std::size_t max_batch = 131072;
  /// The CPU checks batches of fewer states; 0: the GPU checks batches of every size. Unset: for each group, the
  /// checker measures at which batch size the GPU becomes faster.
  std::optional<std::size_t> cpu_below;
  std::string shader_folder;  ///< empty: the installed shaders, or those of the source tree (see shaderFolder())
};

/// The work of the GPU for one batch, summed over its states. An instance is a shape at its place in the scene. For the
/// stages, see docs/architecture.md.
struct GpuWork
{
  std::size_t states = 0;      ///< checked by the GPU
  std::size_t candidates = 0;  ///< pairs of instances whose spheres or outer boxes overlap; a pair counts in each state
  std::size_t root_pairs = 0;  ///< candidates whose root boxes overlap too
  std::size_t traversed = 0;   ///< root pairs whose trees are traversed, because no balls prove a verdict

  GpuWork& operator+=(const GpuWork& other)
  {
    states += other.states;
    candidates += other.candidates;
    root_pairs += other.root_pairs;
    traversed += other.traversed;
    return *this;
  }
};
}  // namespace gpu_planning_scene::core
