#include "collision/work_queue.h"

#include "interface.h"

namespace gpu_planning_scene
{
namespace
{
/// Passes that are queued before the CPU looks whether anything is left.
constexpr std::uint32_t kPassesAtOnce = 2;
}  // namespace

void WorkQueue::run(BatchLists& lists, std::uint32_t /*levels*/)
{
  program_.set(2, std::max(lists.capacity.node_pairs, lists.capacity.items));
  std::uint32_t in_counter = COUNTER_ITEMS;
  for (std::uint32_t pass = 0, left = 1; left != 0; ++pass)
  {
    const std::uint32_t out_counter = pass % 2 == 0 ? COUNTER_ENTRIES_ODD : COUNTER_ENTRIES_EVEN;
    arguments_.prepare(in_counter, std::max(lists.capacity.node_pairs, lists.capacity.items), QUEUE_LANES,
                       QUEUE_MAX_GROUPS, out_counter);
    program_.set(0, in_counter);
    program_.set(1, out_counter);
    lists.node_pairs[pass % 2].bindTexture(UNIT_ENTRIES);
    lists.node_pairs[1 - pass % 2].buffer().bindStorage(BINDING_OUT);
    program_.dispatchIndirect(lists.counters, ArgumentsKernel::argumentsOffset());
    in_counter = out_counter;
    if (pass % kPassesAtOnce == kPassesAtOnce - 1)
      lists.counters.read(&left, sizeof(left), out_counter * sizeof(std::uint32_t));
  }
}
}  // namespace gpu_planning_scene
