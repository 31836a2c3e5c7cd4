#include "collision/gpu/traversal/breadth_first.h"

#include <algorithm>
#include <array>

#include "shader_constants.h"

// Four dispatches per level: test the child pairs, sum the counts, write the next level's list and the leaf pairs, test
// the triangles of the leaf pairs (Gress and Zachmann 2003).
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t offsetOf(std::size_t counter)
{
  return counter * sizeof(std::uint32_t);
}
}  // namespace

BreadthFirst::BreadthFirst(const std::string& folder, const std::string& definitions)
  : arguments_(folder),
    sizes_(folder, "traversal/level_sizes.comp"),
    children_(folder, "traversal/level_children.comp", definitions),
    overlap_(folder, "traversal/level_overlap.comp", definitions),
    triangles_(folder, "traversal/level_triangles.comp", definitions)
{
}

void BreadthFirst::reserve(const ListCapacities& capacity)
{
  // A level has root pairs or node pairs.
  const std::size_t level = std::max(capacity.root_pairs, capacity.node_pairs);
  masks_.reserve(level * sizeof(std::uint32_t));
  constexpr int kGroup = LEVEL_GROUP;
  sums_.reserve((level / kGroup + 1) * 2 * sizeof(std::uint32_t));
  leaf_pairs_.reserve(std::size_t{capacity.leaf_pairs} * TexelBuffer::kTexelBytes);
}

void BreadthFirst::prepare(const TraversalTask& task)
{
  overlap_.forTask(task);
  triangles_.forTask(task);
}

void BreadthFirst::start(BatchLists& lists, const TraversalTask& task)
{
  reserve(lists.capacity);
  const Program& overlap = overlap_.forTask(task);
  const Program& triangles = triangles_.forTask(task);
  const std::array<const Program*, 3> level_programs = {&overlap, &sizes_, &children_};
  const std::uint32_t capacity = lists.capacity.node_pairs;
  std::uint32_t in_counter = (task.solids ? LIST_SOLID_ENTRIES : LIST_MESH_ENTRIES) + LIST_LENGTH;
  arguments_.prepare(in_counter, lists.capacity.root_pairs, LEVEL_GROUP, COUNTER_ENTRIES_ODD);
  for (const Program* program : level_programs)
  {
    program->set(LOCATION_ENTRY_CAPACITY, capacity);
    program->set(LOCATION_LEAF_PAIR_CAPACITY, lists.capacity.leaf_pairs);
  }
  leaf_pairs_.bindTexture(UNIT_LEAF_PAIRS);
  // The list is empty as soon as all pairs have ended; the remaining dispatches then do nothing.
  for (std::uint32_t level = 0; level < task.levels; ++level)
  {
    const std::uint32_t out_counter = level % 2 == 0 ? COUNTER_ENTRIES_ODD : COUNTER_ENTRIES_EVEN;
    for (const Program* program : level_programs)
    {
      program->set(LOCATION_IN_COUNTER, in_counter);
      program->set(LOCATION_OUT_COUNTER, out_counter);
      program->set(LOCATION_IN_CAPACITY, level == 0 ? lists.capacity.root_pairs : capacity);
    }
    const TexelBuffer& entries = task.solids ? lists.solid_entries : lists.mesh_entries;
    (level == 0 ? entries : lists.node_pairs[level % 2]).bindTexture(UNIT_ENTRIES);
    sizes_.set(LOCATION_IS_LAST, level + 1 == task.levels ? 1U : 0U);
    masks_.bindStorage(BINDING_A);
    sums_.bindStorage(BINDING_B);
    overlap.dispatchIndirect(lists.counters, offsetOf(COUNTER_ARGUMENTS));
    sizes_.dispatch(1);
    lists.node_pairs[1 - level % 2].buffer().bindStorage(BINDING_C);
    leaf_pairs_.buffer().bindStorage(BINDING_D);
    children_.dispatchIndirect(lists.counters, offsetOf(COUNTER_CHUNK_ARGUMENTS));
    triangles.dispatchIndirect(lists.counters, offsetOf(COUNTER_LEAF_ARGUMENTS));
    in_counter = out_counter;
  }
}
}  // namespace gpu_planning_scene::core
