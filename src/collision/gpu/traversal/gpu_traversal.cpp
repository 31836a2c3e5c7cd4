#include "collision/gpu/traversal/gpu_traversal.h"

#include <algorithm>

#include "collision/gpu/traversal/breadth_first.h"
#include "collision/gpu/traversal/work_queue.h"
#include "gpu/gl_check.h"
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

BatchLists::BatchLists(const ListCapacities& fixed) : counters(COUNTER_WORDS * sizeof(std::uint32_t)), fixed_(fixed) {}

void BatchLists::reserve(std::size_t states, std::size_t max_bytes)
{
  // The defaults suffice for most parts: the average need of a state, plus a constant for small parts. Large parts get
  // less for a state, to save memory. If a scene needs more, its parts are split and stay smaller.
  constexpr std::size_t kFullStates = 16384;
  const std::size_t counted = std::min(states, kFullStates) + (states - std::min(states, kFullStates)) / 4;
  // A dispatch over a list has at most MAX_GROUPS work groups.
  constexpr std::size_t kMost = std::size_t{MAX_GROUPS} * std::min(GROUP_SIZE, QUEUE_INVOCATIONS);
  const auto grown =
      [counted, max_bytes](std::uint32_t now, std::uint32_t fixed, std::size_t per_state, std::size_t entry_bytes)
  {
    const std::size_t wanted = std::min({counted * per_state + 65536, max_bytes / entry_bytes, kMost});
    return fixed ? fixed : std::max(now, static_cast<std::uint32_t>(wanted));
  };
  constexpr std::size_t kTexel = TexelBuffer::kTexelBytes;
  ListCapacities wanted;
  wanted.open_pairs = grown(capacity.open_pairs, fixed_.open_pairs, 64, kTexel);  // a texel holds two of them
  wanted.candidates = grown(capacity.candidates, fixed_.candidates, 96, kTexel);  // a texel holds two of them
  wanted.root_pairs = grown(capacity.root_pairs, fixed_.root_pairs, 24, ROOT_PAIR_TEXELS * kTexel);
  wanted.node_pairs = grown(capacity.node_pairs, fixed_.node_pairs, 128, kTexel);
  wanted.leaf_pairs = grown(capacity.leaf_pairs, fixed_.leaf_pairs, 64, kTexel);
  try
  {
    for (Buffer* list : {&open_self_pairs, &open_world_pairs, &fine_pairs})
      list->reserve((std::size_t{wanted.open_pairs} + 1) / 2 * kTexel, max_bytes);
    open_states.reserve(states * sizeof(std::uint32_t), max_bytes);
    candidates.reserve((std::size_t{wanted.candidates} + 1) / 2 * kTexel);
    root_pairs.reserve(std::size_t{wanted.root_pairs} * ROOT_PAIR_TEXELS * kTexel);
    mesh_entries.reserve(std::size_t{wanted.root_pairs} * kTexel);
    solid_entries.reserve(std::size_t{wanted.root_pairs} * kTexel);
    for (TexelBuffer& list : node_pairs)
      list.reserve(std::size_t{wanted.node_pairs} * kTexel);
  }
  catch (const OutOfDeviceMemory& error)
  {
    throw OutOfDeviceMemory(std::string(error.what()) + "; choose a smaller max_batch (" + std::to_string(states) +
                            " states did not fit)");
  }
  capacity = wanted;  // last, so that no capacity is more than its list holds, even if an allocation throws
}

void BatchLists::clearCounters()
{
  std::array<std::uint32_t, COUNTER_WORDS> empty = {};
  for (std::size_t list = LIST_OPEN_SELF_PAIRS; list <= LIST_MESH_REST; list += LIST_WORDS)
    empty[list + 1] = empty[list + 2] = 1;  // groups along y and z
  counters.write(empty.data(), sizeof(empty));
}

TaskPrograms::TaskPrograms(std::string shader_folder, std::string name, std::string definitions)
  : folder_(std::move(shader_folder)), name_(std::move(name)), definitions_(std::move(definitions))
{
}

const Program& TaskPrograms::forTask(const TraversalTask& task)
{
  // The programs for solids always handle required distances.
  const bool padded = task.padded && !task.solids;
  auto& program = programs_[task.solids ? 2 : padded ? 1 : 0];
  if (!program)
  {
    std::string definitions = definitions_;
    if (task.solids)
      definitions += "#define SOLIDS 1\n";
    if (padded)
      definitions += "#define PADDED 1\n";
    program.emplace(folder_, name_, definitions);
  }
  return *program;
}

std::unique_ptr<GpuTraversal> makeTraversal(Traversal traversal, const std::string& shader_folder,
                                            const std::string& definitions)
{
  if (traversal == Traversal::BreadthFirst)
    return std::make_unique<BreadthFirst>(shader_folder, definitions);
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
}  // namespace gpu_planning_scene::core
