#pragma once

#include "collision/gpu/traversal/gpu_traversal.h"

namespace gpu_planning_scene::core
{
/// Gress and Zachmann 2003: level by level over packed lists of overlapping node pairs; sums of overlap counts place
/// the next level's pairs (shaders/traversal/level.glsl). The CPU does not wait in between: each level sizes the next
/// one's dispatches.
class BreadthFirst : public GpuTraversal
{
 public:
  BreadthFirst(const std::string& shader_folder, const std::string& definitions, const ListCapacities& capacities);
  void prepare(const TraversalTask& task) override;
  void start(BatchLists& lists, const TraversalTask& task) override;

 private:
  ArgumentsKernel arguments_;
  Program scan_, expand_;
  TaskPrograms overlap_, triangles_;
  Buffer masks_, sums_;
  TexelBuffer leaf_pairs_;
};
}  // namespace gpu_planning_scene::core
