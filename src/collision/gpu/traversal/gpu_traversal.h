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
/// How long the lists of a batch may get. A list that is too short makes the batch be split.
struct ListCapacities
{
  std::uint32_t candidates = 0;  ///< pairs of instances whose spheres or outer boxes overlap
  std::uint32_t root_pairs = 0;  ///< of them, those whose root boxes overlap
  std::uint32_t node_pairs = 0;  ///< of one level (breadth-first), or spilled (work queues)
  std::uint32_t leaf_pairs = 0;  ///< of one level (breadth-first)
};

/// The lists of a batch in GPU memory, see shaders/shader_constants.h and shaders/traversal/root pairs.glsl.
struct BatchLists
{
  explicit BatchLists(const ListCapacities& capacities);

  ListCapacities capacity;
  Buffer counters;
  TexelBuffer candidates, root_pairs;
  TexelBuffer mesh_entries, solid_entries;  ///< the root pairs' root pairs: of two meshes, of a mesh and a solid
  std::array<TexelBuffer, 2> node_pairs;    ///< what traversals leave for the next level or pass, in turns
};

/// What a traversal has before it.
struct TraversalTask
{
  bool solids = false;       ///< pairs of a mesh and a solid, else of two meshes
  bool padded = false;       ///< some pairs have a required distance
  float tolerance = 0.0F;    ///< metres
  std::uint32_t levels = 1;  ///< no tree has more
};

/// The programs of one shader, one for each kind of task, compiled when it is wanted for the first time: merely to hold
/// the code for what a task does not need halves the speed on llvmpipe.
class TaskPrograms
{
 public:
  /// What of a task makes a difference to a shader.
  enum class Needs
  {
    All,
    NoPadding,
    NoTolerance
  };
  TaskPrograms(std::string shader_folder, std::string name, std::string definitions, Needs needs);
  const Program& forTask(const TraversalTask& task);

 private:
  std::string folder_, name_, definitions_;
  Needs needs_;
  std::array<std::optional<Program>, 8> programs_;
};

/// Takes the node pairs of a batch to their ends: every pair of overlapping leaves has its triangles tested.
/// Used on the context's thread, with the scene and the lists bound.
class GpuTraversal
{
 public:
  virtual ~GpuTraversal() = default;

  /// Compiles what `start` needs for such a task.
  virtual void prepare(const TraversalTask& task) = 0;

  /// Traverses from the entries of the task's kind, without waiting for the device: where something is left undone, as
  /// a list overflowed or the device ended work early, counters[COUNTER_OVERFLOW] says so.
  virtual void start(BatchLists& lists, const TraversalTask& task) = 0;
};

/// `definitions`: for the programs, see Program.
std::unique_ptr<GpuTraversal> makeTraversal(Traversal traversal, const std::string& shader_folder,
                                            const std::string& definitions, const ListCapacities& capacities);

/// Dispatches that size other dispatches.
class ArgumentsKernel
{
 public:
  explicit ArgumentsKernel(const std::string& shader_folder) : program_(shader_folder, "common/indirect_arguments.comp")
  {
  }

  /// Writes indirect arguments for a list of counters[counter] elements, at most `capacity`, in workgroups of `lanes`;
  /// sets counters[cleared] to 0.
  void prepare(std::uint32_t counter, std::uint32_t capacity, std::uint32_t lanes, std::uint32_t cleared) const;
  static std::size_t argumentsOffset();

 private:
  Program program_;
};
}  // namespace gpu_planning_scene::core
