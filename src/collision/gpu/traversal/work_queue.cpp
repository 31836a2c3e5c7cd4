#include "collision/gpu/traversal/work_queue.h"

#include "shader_constants.h"

// Starts two passes without waiting. The lists count their work groups themselves.
// Sources: invocations fetch new work until none remains (T. Aila, S. Laine: Understanding the Efficiency of Ray
// Traversal on GPUs. HPG 2009); work groups with queues traverse pairs of trees (C. Lauterbach, Q. Mo, D. Manocha:
// gProximity: Hierarchical GPU-based Operations for Collision and Distance Queries. Computer Graphics Forum 29(2),
// 2010). The shared list of leaf pairs is our own method: it keeps all invocations busy with triangle tests.
namespace gpu_planning_scene::core
{
void WorkQueue::start(BatchLists& lists, const TraversalTask& task)
{
  const Program& program = programs_.forTask(task);
  program.set(LOCATION_ENTRY_CAPACITY, lists.capacity.node_pairs);
  const TexelBuffer& entries = task.solids ? lists.solid_entries : lists.mesh_entries;
  TexelBuffer& rest = lists.node_pairs[task.solids ? 0 : 1];
  const std::uint32_t entry_list = task.solids ? LIST_SOLID_ENTRIES : LIST_MESH_ENTRIES;
  const std::uint32_t rest_list = task.solids ? LIST_SOLID_REST : LIST_MESH_REST;
  rest.buffer().bindStorage(BINDING_A);
  for (const bool is_last : {false, true})
  {
    const std::uint32_t in_list = is_last ? rest_list : entry_list;
    program.set(LOCATION_IN_LIST, in_list);
    program.set(LOCATION_OUT_LIST, rest_list);
    program.set(LOCATION_PASS,
                is_last ? (task.solids ? PASS_SOLID_REST : PASS_MESH_REST) : (task.solids ? PASS_SOLIDS : PASS_MESHES));
    program.set(LOCATION_IN_CAPACITY, is_last ? lists.capacity.node_pairs : lists.capacity.root_pairs);
    program.set(LOCATION_IS_LAST, is_last ? 1U : 0U);
    (is_last ? rest : entries).bindTexture(UNIT_ENTRIES);
    program.dispatchIndirect(lists.counters, in_list * sizeof(std::uint32_t));
  }
}
}  // namespace gpu_planning_scene::core
