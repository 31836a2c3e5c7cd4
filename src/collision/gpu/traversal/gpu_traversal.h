#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu_planning_scene/batch_checker_options.h"

namespace gpu_planning_scene::core
{
/// Capacities of the lists of a part of a batch, in entries. If a list overflows, the part is split.
struct ListCapacities
{
  std::uint32_t open_pairs = 0;  ///< pairs that enclosing balls do not prove, of each kind
  std::uint32_t candidates = 0;  ///< pairs of instances for the trees
  std::uint32_t root_pairs = 0;  ///< candidates whose root boxes overlap
  std::uint32_t node_pairs = 0;  ///< of one level (breadth-first), or left for the last pass (work queues)
  std::uint32_t leaf_pairs = 0;  ///< leaf pairs of one level (breadth-first)
};

/// The lists of a part in GPU memory, see shaders/shader_constants.h and shaders/traversal/root_pairs.glsl. Parts use
/// the same lists one after the other.
class BatchLists
{
 public:
  /// `fixed`: capacities that do not depend on the number of states; 0: the default capacity.
  explicit BatchLists(const ListCapacities& fixed);

  /// Grows the lists to the default capacities for a part of `states` states, but each to at most `max_bytes`, which is
  /// TexelBuffer::maxBytes() except in tests. Throws OutOfDeviceMemory, which names max_batch, if the device has too
  /// little memory, and DeviceLost if OpenGL fails otherwise.
  void reserve(std::size_t states, std::size_t max_bytes);

  ListCapacities capacity;
  /// Fills the counters with those of empty lists.
  void clearCounters();

  Buffer counters;
  Buffer open_self_pairs, open_world_pairs, fine_pairs, open_states;
  TexelBuffer candidates, root_pairs;
  TexelBuffer mesh_entries, solid_entries;  ///< node pairs to start from: of two meshes; of a mesh and a solid
  /// Breadth-first: node pairs for the next level, by turns. Work queues: those for the last pass, solids first.
  std::array<TexelBuffer, 2> node_pairs;

 private:
  ListCapacities fixed_;
};

/// The task of one traversal.
struct TraversalTask
{
  bool solids = false;       ///< true: pairs of a mesh and a solid; false: pairs of two meshes
  bool padded = false;       ///< some pairs have a required distance
  std::uint32_t levels = 1;  ///< upper bound of the levels of a tree
};

/// The programs of one shader, one for each kind of task. A program is compiled when it is first needed. The reason for
/// separate programs: on llvmpipe, code that a task does not need halves the speed even if it never runs.
class TaskPrograms
{
 public:
  TaskPrograms(std::string shader_folder, std::string name, std::string definitions);
  const Program& forTask(const TraversalTask& task);

 private:
  std::string folder_, name_, definitions_;
  std::array<std::optional<Program>, 3> programs_;
};

/// Traverses the trees of all root pairs of a batch down to the leaves, and tests the triangles of each pair of
/// overlapping leaves. Used on the context's thread, with the scene and the lists bound.
class GpuTraversal
{
 public:
  virtual ~GpuTraversal() = default;

  /// Compiles the programs that `start` needs for this task.
  virtual void prepare(const TraversalTask& task) = 0;

  /// Starts the traversal from the entries of the task's kind, without waiting for the device. Sets
  /// counters[COUNTER_OVERFLOW] if work is left undone, because a list overflowed or the device ended invocations
  /// early.
  virtual void start(BatchLists& lists, const TraversalTask& task) = 0;

  /// Whether the passes have counters (PASS_*) that the last dispatch of a part must check.
  virtual bool hasQueues() const { return false; }
};

/// `definitions`: preprocessor definitions for the programs, see Program.
std::unique_ptr<GpuTraversal> makeTraversal(Traversal traversal, const std::string& shader_folder,
                                            const std::string& definitions);

/// A kernel that computes the size of a later indirect dispatch on the device, for lists that do not count their work
/// groups.
class ArgumentsKernel
{
 public:
  explicit ArgumentsKernel(const std::string& shader_folder) : program_(shader_folder, "common/indirect_arguments.comp")
  {
  }

  /// Writes the indirect arguments for a list of counters[counter] elements, at most `capacity`, in work groups that
  /// handle `invocations` elements each. Sets counters[cleared] to 0.
  void prepare(std::uint32_t counter, std::uint32_t capacity, std::uint32_t invocations, std::uint32_t cleared) const;

 private:
  Program program_;
};
}  // namespace gpu_planning_scene::core
