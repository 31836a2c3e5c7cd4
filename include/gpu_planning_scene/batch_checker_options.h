#pragma once

#include <cstddef>
#include <cstdint>
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

/// When a device counts as unusable.
struct DeviceLimits
{
  /// If a device makes no progress for longer than this, it counts as hanging and is never used again. The limit of a
  /// scene is device_seconds * (1 + millions of triangles), because their trees are built meanwhile. Infinite: none.
  double device_seconds = 30.0;
  /// After this many losses within loss_window seconds, or two within a batch or a scene, the device rests.
  std::size_t max_losses = 3;
  double loss_window = 60.0;
  double retry_seconds = 60.0;  ///< time after which a device is tried again
};

/// Events of the devices of a checker since the start.
struct DeviceHistory
{
  std::uint64_t losses = 0;          ///< noticed losses of a device, or of an ability of a device
  std::uint64_t rebuilds = 0;        ///< reopened devices
  std::uint64_t batches_on_cpu = 0;  ///< batches of more than a few hundred states while no device was usable
  bool on_cpu = false;               ///< the CPU answers now, because no device is usable
  bool rebuild_failed = false;       ///< a device was lost and has not been reopened successfully
  std::string last_error;            ///< last error of a device; empty: none
};

struct BatchCheckerOptions : CheckerOptions
{
  /// "auto" (the first hardware device; without any, the CPU, or a software renderer if device_only is set),
  /// "software", an index (Device::index), a part of a renderer's name, several of these ("0+1"), or "all" (all
  /// hardware devices that can be opened; without any, like "auto").
  std::string device = "auto";
  Traversal traversal = Traversal::WorkQueue;
  /// The most states that go to a device at once. It gets fewer if so many would take it more than 50 ms, overflow its
  /// lists, or exceed its largest buffer texture. 131,072 states need about 350 MB of the GPU's memory (420 MB with
  /// Traversal::BreadthFirst), plus 64 bytes for each shape of the robot in each state.
  std::size_t max_batch = 131072;
  /// True: the devices check all states that they can. False: the cores of the CPU check states too, and all states of
  /// small batches; but with a software renderer, which runs on the cores itself, it is as with true.
  bool device_only = false;
  DeviceLimits limits;
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
