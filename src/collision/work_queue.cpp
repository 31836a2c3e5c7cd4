#include "collision/work_queue.h"

#include <algorithm>
#include <array>

#include "interface.h"

namespace gpu_planning_scene
{
bool WorkQueue::run(BatchLists& lists, const TraversalTask& task)
{
  const Program& program = programs_.forTask(task);
  const std::uint32_t capacity = lists.capacity.node_pairs;
  program.set(2, capacity);
  if (task.tolerance > 0.0F)
    program.setFloat(5, task.tolerance);
  std::uint32_t in_counter = task.solids ? COUNTER_SOLID_ENTRIES : COUNTER_MESH_ENTRIES;
  lists.counters.clear(COUNTER_LANES_ENDED * sizeof(std::uint32_t), 2 * sizeof(std::uint32_t));
  std::array<std::uint32_t, COUNTER_WORDS> counters{};
  // One pass, as a rule: what follows is for what the stacks or the granted iterations were too short for.
  for (std::uint32_t pass = 0;; ++pass)
  {
    const std::uint32_t out_counter = pass % 2 == 0 ? COUNTER_ENTRIES_ODD : COUNTER_ENTRIES_EVEN;
    const std::uint32_t in_capacity = pass == 0 ? lists.capacity.items : capacity;
    program.set(0, in_counter);
    program.set(1, out_counter);
    program.set(3, in_capacity);
    lists.counters.clear(COUNTER_NEXT_ENTRY * sizeof(std::uint32_t), sizeof(std::uint32_t));
    lists.counters.clear(out_counter * sizeof(std::uint32_t), sizeof(std::uint32_t));
    const TexelBuffer& entries = task.solids ? lists.solid_entries : lists.mesh_entries;
    (pass == 0 ? entries : lists.node_pairs[pass % 2]).bindTexture(UNIT_ENTRIES);
    lists.node_pairs[1 - pass % 2].buffer().bindStorage(BINDING_A);
    do
    {
      arguments_.prepare(in_counter, in_capacity, QUEUE_LANES, QUEUE_MAX_GROUPS, COUNTER_UNUSED);
      program.dispatchIndirect(lists.counters, ArgumentsKernel::argumentsOffset());
      lists.counters.read(counters.data(), sizeof(counters));
      if (counters[COUNTER_OVERFLOW] != 0 || counters[COUNTER_LANES_ENDED] != counters[COUNTER_LANES_STARTED])
        return false;
    } while (counters[COUNTER_NEXT_ENTRY] < std::min(counters[in_counter], in_capacity));
    if (counters[out_counter] == 0)
      return true;
    in_counter = out_counter;
  }
}
}  // namespace gpu_planning_scene
