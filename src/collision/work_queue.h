#pragma once

#include "collision/gpu_traversal.h"

namespace gpu_planning_scene
{
/// Every lane walks node pairs with a stack of its own, a workgroup shares a list of leaf pairs
/// (shaders/work_queue.comp). A pass that could not finish within the iterations that a device grants hands on what is
/// left to the next pass.
class WorkQueue : public GpuTraversal
{
 public:
  WorkQueue(const std::string& shader_folder, const std::string& definitions)
    : arguments_(shader_folder), programs_(shader_folder, "work_queue.comp", definitions)
  {
  }
  bool run(BatchLists& lists, const TraversalTask& task) override;

 private:
  ArgumentsKernel arguments_;
  TaskPrograms programs_;
};
}  // namespace gpu_planning_scene
