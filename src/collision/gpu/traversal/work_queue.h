#pragma once

#include "collision/gpu/traversal/gpu_traversal.h"

namespace gpu_planning_scene::core
{
/// Depth-first traversal with work queues (shaders/traversal/work_queue.comp). Each invocation walks node pairs with
/// its own stack, and a work group shares a list of leaf pairs. If a pass cannot finish within the iterations that a
/// device allows, it leaves the remaining node pairs to the next pass.
class WorkQueue : public GpuTraversal
{
 public:
  WorkQueue(const std::string& shader_folder, const std::string& definitions)
    : pass_program_(shader_folder, "traversal/queue_pass.comp"),
      programs_(shader_folder, "traversal/work_queue.comp", definitions, TaskPrograms::Needs::All)
  {
  }
  void prepare(const TraversalTask& task) override { programs_.forTask(task); }
  void start(BatchLists& lists, const TraversalTask& task) override;

 private:
  void preparePass(std::uint32_t in_counter, std::uint32_t in_capacity, std::uint32_t out_counter, bool is_last) const;

  Program pass_program_;
  TaskPrograms programs_;
};
}  // namespace gpu_planning_scene::core
