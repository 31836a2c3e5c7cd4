#include "collision/gpu_pair_checker.h"

#include <algorithm>
#include <limits>

#include "gpu/float_arithmetic.h"
#include "gpu/gl_check.h"
#include "interface.h"

namespace gpu_planning_scene
{
namespace
{
constexpr std::uint32_t kNoLimit = std::numeric_limits<std::uint32_t>::max();

/// Room that is enough for most batches: what a state leaves behind on average, and some for batches of few states.
ListCapacities withDefaults(ListCapacities capacities, std::size_t max_states)
{
  const auto per_state = [&](std::uint32_t chosen, std::size_t count)
  { return chosen ? chosen : static_cast<std::uint32_t>(std::min<std::size_t>(max_states * count + 65536, 1U << 25)); };
  capacities.candidates = per_state(capacities.candidates, 96);
  capacities.items = per_state(capacities.items, 24);
  capacities.node_pairs = per_state(capacities.node_pairs, 128);
  capacities.leaf_pairs = per_state(capacities.leaf_pairs, 64);
  return capacities;
}
}  // namespace

GpuPairChecker::GpuPairChecker(const std::string& folder, Traversal traversal, std::size_t max_states,
                               const ListCapacities& capacities)
  : float_fault_(findFloatFault(folder)),
    definitions_(float_fault_.empty() ? "" : "#define FLOATS_DECIDE 0\n"),
    scene_(folder),
    max_states_(std::max<std::size_t>(1, max_states)),
    part_(max_states_),
    lists_(withDefaults(capacities, max_states_)),
    traversal_(makeTraversal(traversal, folder, definitions_, lists_.capacity)),
    arguments_(folder),
    spheres_program_(folder, "check_spheres.comp"),
    self_program_(folder, "check_self_broad.comp"),
    world_program_(folder, "check_world_broad.comp"),
    roots_program_(folder, "check_roots.comp", definitions_),
    half_spaces_program_(folder, "check_half_spaces.comp", definitions_),
    inside_program_(folder, "check_inside.comp", definitions_)
{
}

std::pair<std::uint32_t, std::uint32_t> GpuPairChecker::pairOf(std::uint32_t hit)
{
  return {hit >> PAIR_OTHER_BITS, hit & ((1U << PAIR_OTHER_BITS) - 1)};
}

void GpuPairChecker::setProblem(const CollisionProblem& problem)
{
  part_ = max_states_;
  scene_.setProblem(problem);
}

void GpuPairChecker::selectPairs(const CollisionProblem& problem)
{
  part_ = max_states_;
  scene_.selectPairs(problem);
}

void GpuPairChecker::check(const float* poses, std::size_t count, Verdicts& verdicts)
{
  verdicts.flags.assign(count, 0);
  verdicts.hits.assign(count, 0);
  if (scene_.robotCount() == 0)
    return;
  for (std::size_t begin = 0; begin < count;)
  {
    const std::size_t part = std::min(part_, count - begin);
    checkPart(poses, begin, part, verdicts);
    begin += part;
  }
}

void GpuPairChecker::checkPart(const float* poses, std::size_t begin, std::size_t count, Verdicts& verdicts)
{
  if (runBatch(poses + begin * scene_.robotCount() * 12, count))
  {
    lists_.flags.read(&verdicts.flags[begin], count * sizeof(std::uint32_t));
    lists_.hits.read(&verdicts.hits[begin], count * sizeof(std::uint32_t));
    return;
  }
  if (count == 1)
  {
    verdicts.flags[begin] = STATE_UNDECIDED;
    return;
  }
  // Batches that follow are likely to be like this one.
  part_ = (count + 1) / 2;
  checkPart(poses, begin, count / 2, verdicts);
  checkPart(poses, begin + count / 2, count - count / 2, verdicts);
}

bool GpuPairChecker::runBatch(const float* poses, std::size_t count)
{
  poses_.reserve(count * scene_.robotCount() * 12 * sizeof(float));
  poses_.buffer().write(poses, count * scene_.robotCount() * 12 * sizeof(float));
  lists_.flags.reserve(count * sizeof(std::uint32_t));
  lists_.flags.clear(0, count * sizeof(std::uint32_t));
  lists_.hits.reserve(count * sizeof(std::uint32_t));
  lists_.counters.clear();

  scene_.bind();
  poses_.bindTexture(UNIT_ROBOT_POSES);
  lists_.items.bindTexture(UNIT_ITEMS);
  lists_.candidates.bindTexture(UNIT_CANDIDATES);
  lists_.counters.bindStorage(BINDING_COUNTERS);
  lists_.flags.bindStorage(BINDING_FLAGS);
  lists_.hits.bindStorage(BINDING_HITS);

  testHalfSpaces(static_cast<std::uint32_t>(count));
  findCandidates(static_cast<std::uint32_t>(count));
  testRoots();
  const bool finished = traverse();
  if (finished)
    testContainment();
  checkGl("a batch");
  return finished;
}

void GpuPairChecker::testHalfSpaces(std::uint32_t states)
{
  if (scene_.halfSpaceCount() == 0)
    return;
  half_spaces_program_.set(0, states);
  half_spaces_program_.set(1, scene_.robotCount());
  half_spaces_program_.set(2, scene_.halfSpaceCount());
  half_spaces_program_.set(3, scene_.worldCount());
  scene_.halfSpaces().bindStorage(BINDING_C);
  scene_.halfSpacePairs().bindStorage(BINDING_D);
  // One at a time: what one lane may do is limited.
  for (std::uint32_t half_space = 0; half_space < scene_.halfSpaceCount(); ++half_space)
  {
    half_spaces_program_.set(4, half_space);
    half_spaces_program_.dispatch(groupsFor(std::size_t{states} * scene_.robotCount()));
  }
}

void GpuPairChecker::findCandidates(std::uint32_t states)
{
  const std::size_t groups = groupsFor(std::size_t{states} * scene_.robotCount());
  for (const Program* program : {&spheres_program_, &self_program_, &world_program_, &roots_program_})
  {
    program->set(0, states);
    program->set(1, scene_.robotCount());
  }
  lists_.candidates.buffer().bindStorage(BINDING_B);
  if (scene_.worldCount() > 0)
  {
    world_program_.set(2, lists_.capacity.candidates);
    world_program_.set(3, scene_.worldCount());
    world_program_.dispatch(groups);
  }
  if (scene_.hasSelfPairs())
  {
    spheres_.reserve(std::size_t{states} * scene_.robotCount() * 16);
    spheres_.buffer().bindStorage(BINDING_A);
    spheres_.bindTexture(UNIT_SPHERES);
    spheres_program_.dispatch(groups);
    self_program_.set(2, lists_.capacity.candidates);
    self_program_.dispatch(groups);
  }
}

void GpuPairChecker::testRoots()
{
  arguments_.prepare(COUNTER_CANDIDATES, lists_.capacity.candidates, GROUP_SIZE, kNoLimit, COUNTER_UNUSED);
  roots_program_.set(2, lists_.capacity.candidates);
  roots_program_.set(3, lists_.capacity.items);
  roots_program_.set(4, scene_.solidNodes());
  scene_.components().bindStorage(BINDING_C);
  lists_.items.buffer().bindStorage(BINDING_A);
  lists_.mesh_entries.buffer().bindStorage(BINDING_B);
  lists_.solid_entries.buffer().bindStorage(BINDING_D);
  roots_program_.dispatchIndirect(lists_.counters, ArgumentsKernel::argumentsOffset());
}

/// Solids first: what is found there costs less.
bool GpuPairChecker::traverse()
{
  TraversalTask task;
  task.padded = scene_.isPadded();
  task.tolerance = scene_.tolerance();
  task.levels = scene_.depthBound();
  if (scene_.solidNodes() != 0)
  {
    task.solids = true;
    if (!traversal_->run(lists_, task))
      return false;
    task.solids = false;
  }
  return traversal_->run(lists_, task);
}

/// Of meshes in meshes and of primitives in meshes; what primitives contain, testRoots has seen.
void GpuPairChecker::testContainment()
{
  if (!scene_.hasMeshSolids())
    return;
  arguments_.prepare(COUNTER_ITEMS, lists_.capacity.items, GROUP_SIZE, kNoLimit, COUNTER_UNUSED);
  inside_program_.set(2, lists_.capacity.items);
  scene_.components().bindStorage(BINDING_C);
  scene_.leafOrder().bindStorage(BINDING_A);
  scene_.solidTriangles().bindStorage(BINDING_B);
  inside_program_.dispatchIndirect(lists_.counters, ArgumentsKernel::argumentsOffset());
}
}  // namespace gpu_planning_scene
