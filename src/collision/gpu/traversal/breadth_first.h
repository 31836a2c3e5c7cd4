#pragma once

#include "collision/gpu/traversal/gpu_traversal.h"

namespace gpu_planning_scene::core
{
/// Breadth-first traversal (Gress and Zachmann 2003). Each level reads a packed list of overlapping node pairs and
/// counts the overlapping child pairs. Prefix sums of the counts place the pairs of the next level
/// (shaders/traversal/level.glsl). The CPU does not wait between levels: each level computes the size of the next
/// level's dispatches.
class BreadthFirst : public GpuTraversal
{
 public:
  BreadthFirst(const std::string& shader_folder, const std::string& definitions);
  void prepare(const TraversalTask& task) override;
  void start(BatchLists& lists, const TraversalTask& task) override;

 private:
  void reserve(const ListCapacities& capacity);

  ArgumentsKernel arguments_;
  Program sizes_, children_;
  TaskPrograms overlap_, triangles_;
  Buffer masks_, sums_;
  TexelBuffer leaf_pairs_;
};
}  // namespace gpu_planning_scene::core
