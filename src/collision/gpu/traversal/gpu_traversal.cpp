#include "collision/gpu/traversal/gpu_traversal.h"

#include "collision/gpu/traversal/breadth_first.h"
#include "collision/gpu/traversal/work_queue.h"
#include "gpu_planning_scene/error.h"
#include "shader_constants.h"

// The parts that both traversals share: the lists in GPU memory, and a program for each kind of task. The methods are
// in breadth_first.h and work_queue.h.
namespace gpu_planning_scene::core
{
Traversal traversalFromName(const std::string& name)
{
  if (name == "breadth_first")
    return Traversal::BreadthFirst;
  if (name == "work_queue")
    return Traversal::WorkQueue;
  throw Error("unknown traversal '" + name + "'; use breadth_first or work_queue");
}

BatchLists::BatchLists(const ListCapacities& capacities)
  : capacity(capacities), counters(COUNTER_WORDS * sizeof(std::uint32_t))
{
  candidates.reserve((std::size_t{capacity.candidates} + 1) / 2 * TexelBuffer::kTexelBytes);
  root_pairs.reserve(std::size_t{capacity.root_pairs} * ROOT_PAIR_TEXELS * TexelBuffer::kTexelBytes);
  mesh_entries.reserve(std::size_t{capacity.root_pairs} * TexelBuffer::kTexelBytes);
  solid_entries.reserve(std::size_t{capacity.root_pairs} * TexelBuffer::kTexelBytes);
  for (TexelBuffer& list : node_pairs)
    list.reserve(std::size_t{capacity.node_pairs} * TexelBuffer::kTexelBytes);
}

TaskPrograms::TaskPrograms(std::string shader_folder, std::string name, std::string definitions, Needs needs)
  : folder_(std::move(shader_folder)), name_(std::move(name)), definitions_(std::move(definitions)), needs_(needs)
{
}

const Program& TaskPrograms::forTask(const TraversalTask& task)
{
  const bool tolerant = task.tolerance > 0.0F && needs_ != Needs::NoTolerance;
  // The programs for solids always handle required distances.
  const bool padded = task.padded && !task.solids && needs_ != Needs::NoPadding;
  auto& program = programs_[(task.solids ? 4 : 0) + (padded ? 2 : 0) + (tolerant ? 1 : 0)];
  if (!program)
  {
    std::string definitions = definitions_;
    if (task.solids)
      definitions += "#define SOLIDS 1\n";
    if (padded)
      definitions += "#define PADDED 1\n";
    if (tolerant)
      definitions += "#define TOLERANT 1\n";
    program.emplace(folder_, name_, definitions);
  }
  return *program;
}

std::unique_ptr<GpuTraversal> makeTraversal(Traversal traversal, const std::string& shader_folder,
                                            const std::string& definitions, const ListCapacities& capacities)
{
  if (traversal == Traversal::BreadthFirst)
    return std::make_unique<BreadthFirst>(shader_folder, definitions, capacities);
  return std::make_unique<WorkQueue>(shader_folder, definitions);
}

void ArgumentsKernel::prepare(std::uint32_t counter, std::uint32_t capacity, std::uint32_t invocations,
                              std::uint32_t cleared) const
{
  program_.set(LOCATION_COUNTER, counter);
  program_.set(LOCATION_CAPACITY, capacity);
  program_.set(LOCATION_INVOCATIONS, invocations);
  program_.set(LOCATION_ARGUMENT_OFFSET, COUNTER_ARGUMENTS);
  program_.set(LOCATION_CLEARED, cleared);
  program_.dispatch(1);
}

std::size_t ArgumentsKernel::argumentsOffset()
{
  return COUNTER_ARGUMENTS * sizeof(std::uint32_t);
}
}  // namespace gpu_planning_scene::core
