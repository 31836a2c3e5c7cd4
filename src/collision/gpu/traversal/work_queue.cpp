#include "collision/gpu/traversal/work_queue.h"

#include "shader_constants.h"

// Runs a fixed number of passes without waiting. Before each pass a small dispatch computes the size of the pass on the
// device; the last one sets the overflow counter if node pairs remain.
// Sources: invocations fetch new work until none remains (T. Aila, S. Laine: Understanding the Efficiency of Ray
// Traversal on GPUs. HPG 2009); work groups with queues traverse pairs of trees (C. Lauterbach, Q. Mo, D. Manocha:
// gProximity: Hierarchical GPU-based Operations for Collision and Distance Queries. Computer Graphics Forum 29(2),
// 2010). The shared list of leaf pairs is our own method: it keeps all invocations busy with triangle tests.
namespace gpu_planning_scene::core
{
namespace
{
/// Each pass but the last hands the node pairs of long traversals on to the next one.
constexpr std::uint32_t kPasses = 4;
}  // namespace

void WorkQueue::start(BatchLists& lists, const TraversalTask& task)
{
  const Program& program = programs_.forTask(task);
  const std::uint32_t capacity = lists.capacity.node_pairs;
  program.set(LOCATION_ENTRY_CAPACITY, capacity);
  if (task.endsEarly())
    program.setFloat(LOCATION_TOLERANCE, task.tolerance);
  std::uint32_t in_counter = task.solids ? COUNTER_SOLID_ENTRIES : COUNTER_MESH_ENTRIES;
  std::uint32_t in_capacity = lists.capacity.root_pairs;
  const TexelBuffer* in_list = task.solids ? &lists.solid_entries : &lists.mesh_entries;
  for (std::uint32_t pass = 0; pass < kPasses; ++pass)
  {
    const std::uint32_t out_counter = pass % 2 == 0 ? COUNTER_ENTRIES_ODD : COUNTER_ENTRIES_EVEN;
    TexelBuffer& out_list = lists.node_pairs[pass % 2];
    preparePass(in_counter, in_capacity, out_counter, false);
    program.set(LOCATION_IN_COUNTER, in_counter);
    program.set(LOCATION_OUT_COUNTER, out_counter);
    program.set(LOCATION_IN_CAPACITY, in_capacity);
    program.set(LOCATION_IS_LAST, pass + 1 == kPasses ? 1U : 0U);
    in_list->bindTexture(UNIT_ENTRIES);
    out_list.buffer().bindStorage(BINDING_A);
    program.dispatchIndirect(lists.counters, ArgumentsKernel::argumentsOffset());
    in_counter = out_counter;
    in_capacity = capacity;
    in_list = &out_list;
  }
  preparePass(in_counter, in_capacity, COUNTER_SCRATCH, true);
}

void WorkQueue::preparePass(std::uint32_t in_counter, std::uint32_t in_capacity, std::uint32_t out_counter,
                            bool is_last) const
{
  pass_program_.set(LOCATION_IN_COUNTER, in_counter);
  pass_program_.set(LOCATION_IN_CAPACITY, in_capacity);
  pass_program_.set(LOCATION_OUT_COUNTER, out_counter);
  pass_program_.set(LOCATION_IS_LAST, is_last ? 1U : 0U);
  pass_program_.dispatch(1);
}
}  // namespace gpu_planning_scene::core
