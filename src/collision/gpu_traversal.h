#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu_planning_scene/batch_checker.h"

namespace gpu_planning_scene
{
/// How long the lists of a batch may get. A list that is too short makes the batch be split.
struct ListCapacities
{
  std::uint32_t candidates = 0;  ///< pairs of instances whose spheres or outer boxes overlap
  std::uint32_t items = 0;       ///< of them, those whose root boxes overlap
  std::uint32_t node_pairs = 0;  ///< of one level (breadth-first), or spilled (work queues); at least `items`
  std::uint32_t leaf_pairs = 0;  ///< of one level (breadth-first)
};

/// The lists of a batch in GPU memory, see shaders/interface.h and shaders/items.glsl.
struct BatchLists
{
  explicit BatchLists(const ListCapacities& capacities);

  ListCapacities capacity;
  Buffer counters, flags, hits;
  TexelBuffer candidates, items;
  std::array<TexelBuffer, 2> node_pairs;  ///< the first one begins with the items' root pairs
};

/// Takes the node pairs of a batch to their ends: every pair of overlapping leaves has its triangles tested.
/// Used on the context's thread, with the scene and the lists bound.
class GpuTraversal
{
 public:
  virtual ~GpuTraversal() = default;

  /// Traverses from the first node-pair list, counters[COUNTER_ITEMS] entries. `levels`: how many levels the deepest
  /// tree may have. `padded`: some pairs have a required distance. Returns false if something was left undone: a list
  /// overflowed, or the device ended work early.
  virtual bool run(BatchLists& lists, std::uint32_t levels, bool padded) = 0;
};

/// For a program that tests triangles, see shaders/leaf_pair.glsl.
inline const std::string kPadded = "#define PADDED 1\n";

/// `definitions`: for the programs, see Program.
std::unique_ptr<GpuTraversal> makeTraversal(Traversal traversal, const std::string& shader_folder,
                                            const std::string& definitions, const ListCapacities& capacities);

/// Dispatches that size other dispatches.
class ArgumentsKernel
{
 public:
  explicit ArgumentsKernel(const std::string& shader_folder) : program_(shader_folder, "check_arguments.comp") {}

  /// Writes indirect arguments for a list of counters[counter] elements, at most `capacity`; sets counters[cleared] to
  /// 0.
  void prepare(std::uint32_t counter, std::uint32_t capacity, std::uint32_t lanes, std::uint32_t max_groups,
               std::uint32_t cleared) const;
  static std::size_t argumentsOffset();

 private:
  Program program_;
};
}  // namespace gpu_planning_scene
