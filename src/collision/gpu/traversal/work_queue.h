#pragma once

#include "collision/gpu/traversal/gpu_traversal.h"

namespace gpu_planning_scene::core
{
/// Depth-first traversal with work queues (shaders/traversal/work_queue.comp). Each invocation walks node pairs with
/// its own stack, and a work group shares a list of leaf pairs. There are two passes: the first one leaves what remains
/// of long traversals to the second one.
class WorkQueue : public GpuTraversal
{
 public:
  WorkQueue(const std::string& shader_folder, const std::string& definitions)
    : programs_(shader_folder, "traversal/work_queue.comp", definitions)
  {
  }
  void prepare(const TraversalTask& task) override { programs_.forTask(task); }
  void start(BatchLists& lists, const TraversalTask& task) override;
  bool hasQueues() const override { return true; }

 private:
  TaskPrograms programs_;
};
}  // namespace gpu_planning_scene::core
