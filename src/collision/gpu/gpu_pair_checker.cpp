#include "collision/gpu/gpu_pair_checker.h"

#include <algorithm>
#include <chrono>

#include "collision/gpu/part_limits.h"
#include "gpu/float_arithmetic.h"
#include "gpu/gl_check.h"
#include "shader_constants.h"

// Queues all dispatches of a part without waiting: kinematics, half-spaces, broad phase, root boxes, proofs, traversal
// and containment. If a list overflows, the device sets a counter, and the part is split and repeated. The traversal on
// the device follows Gress and Zachmann (2003); the queue of dispatches and the split are our own method.
namespace gpu_planning_scene::core
{
namespace
{
/// The order of queries is learned from at most this many states of a batch.
constexpr std::size_t kMaxCounted = 16384;

constexpr std::size_t kFirstPart = 2048;

/// Byte offsets in the results of a part: counters, then flags, then hits. `list_bytes` is the size of the flags and of
/// the hits.
struct AnswerOffsets
{
  explicit AnswerOffsets(std::size_t count)
    : list_bytes((count * sizeof(std::uint32_t) + Buffer::kStorageAlignment - 1) / Buffer::kStorageAlignment *
                 Buffer::kStorageAlignment),
      hits(flags + list_bytes),
      end(hits + list_bytes)
  {
  }
  std::size_t list_bytes;
  std::size_t flags = Buffer::kStorageAlignment;
  std::size_t hits;
  std::size_t end;
};
static_assert(COUNTER_WORDS * sizeof(std::uint32_t) <= Buffer::kStorageAlignment, "they lie before the flags");
}  // namespace

GpuPairChecker::Programs::Programs(const std::string& folder, const std::string& definitions)
  : spheres(folder, "broad_phase/spheres.comp", definitions),
    world(folder, "broad_phase/world_pairs.comp", definitions),
    self(folder, "broad_phase/self_pairs.comp", definitions),
    roots(folder, "broad_phase/root_pairs.comp", definitions),
    half_spaces(folder, "broad_phase/half_spaces.comp", definitions)
{
}

GpuPairChecker::GpuPairChecker(const std::string& folder, Traversal traversal, std::size_t max_states,
                               const ListCapacities& capacities, double part_seconds)
  : float_fault_(findFloatFault(folder)),
    definitions_(float_fault_.empty() ? "" : "#define FLOAT32_TRUSTED 0\n"),
    scene_(folder),
    max_states_(std::max<std::size_t>(1, max_states)),
    plain_parts_({part_seconds, kFirstPart, 1, max_states_}),
    parts_with_margins_({part_seconds, kFirstPart, 1, max_states_}),
    lists_(capacities),
    traversal_(makeTraversal(traversal, folder, definitions_)),
    arguments_(folder),
    folder_(folder),
    plain_(folder, definitions_),
    proofs_program_(folder, "broad_phase/prove_pairs.comp", definitions_),
    inside_program_(folder, "traversal/containment.comp", definitions_),
    done_program_(folder, "common/batch_done.comp")
{
}

std::pair<std::uint32_t, std::uint32_t> GpuPairChecker::pairOf(std::uint32_t hit)
{
  return {hit >> PAIR_OTHER_BITS, hit & ((1U << PAIR_OTHER_BITS) - 1)};
}

void GpuPairChecker::setProblem(const CollisionProblem& problem)
{
  proofs_.clear();
  scene_.setProblem(problem);
  order_.setPairs(problem);
  margins_.setPairs(problem);
  prepare();
}

void GpuPairChecker::selectPairs(const CollisionProblem& problem)
{
  scene_.selectPairs(problem);
  order_.setPairs(problem);
  margins_.setPairs(problem);
  prepare();
}

void GpuPairChecker::useProofs(const RobotProofs& proofs, const CollisionProblem& problem, bool tables)
{
  if (!float_fault_.empty())
    return;  // they would prove nothing
  proofs_.clear();
  if (tables && !self_with_tables_)
    self_with_tables_.emplace(folder_, "broad_phase/self_pairs.comp", definitions_ + "#define JOINT_TABLES 1\n");
  proofs_.set(proofs, problem);
}

/// Compiles programs, sizes the parts and allocates the lists, so that the first batch does not have to. The next
/// states may take much longer than the last ones, so the parts begin small again.
void GpuPairChecker::prepare()
{
  writeQueries();
  const std::size_t room = maxStatesOfPart(TexelBuffer::maxBytes(), scene_.robotCount(),
                                           std::max(queries_.world.size(), queries_.self.size()));
  plain_parts_.setMax(std::min(max_states_, room));
  parts_with_margins_.setMax(std::max<std::size_t>(1, std::min({max_states_, room, margins_.maxStates()})));
  for (BatchSize* parts : {&plain_parts_, &parts_with_margins_})
    parts->restart();
  lists_.reserve(plain_parts_.size(), TexelBuffer::maxBytes());
  traversal_->prepare(task(false, scene_.isPadded()));
  if (scene_.solidNodes() != 0)
    traversal_->prepare(task(true, scene_.isPadded()));
}

void GpuPairChecker::prepareMargins()
{
  if (!with_margins_)
    with_margins_.emplace(folder_, definitions_ + "#define MARGINS 1\n");
  for (const bool solids : {false, true})
    if (!solids || scene_.solidNodes() != 0)
      traversal_->prepare(task(solids, true));
}

void GpuPairChecker::check(PoseSource& source, std::size_t count, Verdicts& verdicts, const Margins* margins,
                           const Done& done)
{
  verdicts.flags.assign(count, 0);
  verdicts.hits.assign(count, 0);
  work_ = {};
  if (scene_.robotCount() == 0)
    return done(0, count);
  const Batch batch{source, margins, margins ? parts_with_margins_ : plain_parts_, verdicts, done};
  if (margins)
    prepareMargins();
  programs_ = margins ? &*with_margins_ : &plain_;
  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  Part* running = nullptr;
  std::size_t begin = 0;
  for (std::size_t i = 0; running || begin < count; ++i)
  {
    Part* next = nullptr;
    if (begin < count)
    {
      next = &parts_[i % 2];
      next->begin = begin;
      next->count = std::min({batch.parts.size(), source.maxStates(), count - begin});
      begin += next->count;
      start(batch, *next);
    }
    if (running)
    {
      const std::size_t states = running->count;
      finish(batch, *running);
      const Clock::time_point now = Clock::now();
      batch.parts.took(states, std::chrono::duration<double>(now - last).count());
      last = now;
    }
    running = next;
  }
  learnOrder(verdicts);
}

void GpuPairChecker::learnOrder(const Verdicts& verdicts)
{
  const std::size_t stride = 1 + verdicts.flags.size() / kMaxCounted;
  for (std::size_t i = 0; i < verdicts.flags.size(); i += stride)
    if (verdicts.flags[i] & STATE_HIT)
    {
      const auto [robot, other] = pairOf(verdicts.hits[i]);
      order_.count(robot, other);
    }
  if (order_.endBatch(verdicts.flags.size()))
    writeQueries();
}

void GpuPairChecker::writeQueries()
{
  queries_ = order_.queries();
  for (const auto& [records, buffer] :
       {std::pair(&queries_.world, &world_queries_), std::pair(&queries_.self, &self_queries_)})
  {
    buffer->reserve(records->size() * sizeof(BroadPhaseQueries::Record));
    buffer->buffer().write(*records);
  }
}

void GpuPairChecker::finish(const Batch& batch, Part& part)
{
  if (fetch(part, batch.verdicts))
    return batch.done(part.begin, part.count);
  const std::size_t begin = part.begin;
  const std::size_t count = part.count;
  if (count == 1)
  {
    batch.verdicts.flags[begin] = STATE_UNDECIDED;
    return batch.done(begin, count);
  }
  batch.parts.tooLarge(count);
  for (const auto& [first, states] : {std::pair(begin, count / 2), std::pair(begin + count / 2, count - count / 2)})
  {
    part.begin = first;
    part.count = states;
    start(batch, part);
    finish(batch, part);
  }
}

bool GpuPairChecker::fetch(Part& part, Verdicts& verdicts)
{
  const AnswerOffsets offsets(part.count);
  const std::uint32_t* words = part.fetched.wait();
  if (words[COUNTER_OVERFLOW] != 0 || words[COUNTER_DONE] != part.serial)
    return false;
  work_.states += part.count;
  work_.candidates += words[COUNTER_CANDIDATES];
  work_.root_pairs += words[COUNTER_ROOT_PAIRS];
  work_.traversed += words[COUNTER_MESH_ENTRIES] + words[COUNTER_SOLID_ENTRIES];
  std::copy_n(words + offsets.flags / sizeof(std::uint32_t), part.count,
              verdicts.flags.begin() + static_cast<std::ptrdiff_t>(part.begin));
  std::copy_n(words + offsets.hits / sizeof(std::uint32_t), part.count,
              verdicts.hits.begin() + static_cast<std::ptrdiff_t>(part.begin));
  return true;
}

/// Starts all of a part's work without waiting for any of it.
void GpuPairChecker::start(const Batch& batch, Part& part)
{
  const AnswerOffsets offsets(part.count);
  part.answers.reserve(offsets.end);
  part.answers.clear(offsets.flags, offsets.list_bytes);
  lists_.reserve(part.count, TexelBuffer::maxBytes());
  lists_.counters.clear();
  poses_.reserve(part.count * scene_.robotCount() * POSE_TEXELS * TexelBuffer::kTexelBytes);
  batch.poses.write(part.begin, part.count, poses_);
  if (batch.margins)
  {
    margins_.write(*batch.margins, part.begin, part.count);
    for (const Program* program : {&programs_->spheres, &programs_->world, &programs_->roots, &programs_->half_spaces})
      program->set(LOCATION_MARGIN_COUNT, static_cast<std::uint32_t>(batch.margins->width));
  }

  scene_.bind();
  poses_.bindTexture(UNIT_ROBOT_POSES);
  lists_.root_pairs.bindTexture(UNIT_ROOT_PAIRS);
  lists_.candidates.bindTexture(UNIT_CANDIDATES);
  lists_.counters.bindStorage(BINDING_COUNTERS);
  part.answers.bindStorage(BINDING_FLAGS, offsets.flags, offsets.list_bytes);
  part.answers.bindStorage(BINDING_HITS, offsets.hits, offsets.list_bytes);

  const auto states = static_cast<std::uint32_t>(part.count);
  testHalfSpaces(states);
  findCandidates(batch, states);
  testRoots();
  proveRootPairs();
  traverse(scene_.isPadded() || batch.margins);
  for (const bool solids : {true, false})
    testContainment(solids);
  part.serial = serial_ = std::max(1U, serial_ + 1U);  // 0 is the value of a cleared counter
  done_program_.set(LOCATION_SERIAL, part.serial);
  done_program_.dispatch(1);
  part.answers.copyFrom(lists_.counters, COUNTER_WORDS * sizeof(std::uint32_t));
  part.fetched.begin(part.answers, offsets.end);
  checkGl("a batch");
}

void GpuPairChecker::testHalfSpaces(std::uint32_t states)
{
  if (scene_.halfSpaceCount() == 0)
    return;
  programs_->half_spaces.set(LOCATION_STATE_COUNT, states);
  programs_->half_spaces.set(LOCATION_ROBOT_COUNT, scene_.robotCount());
  programs_->half_spaces.set(LOCATION_HALF_SPACE_COUNT, scene_.halfSpaceCount());
  programs_->half_spaces.set(LOCATION_WORLD_COUNT, scene_.worldCount());
  scene_.halfSpaces().bindStorage(BINDING_C);
  scene_.halfSpacePairs().bindStorage(BINDING_D);
  // One dispatch per half-space, because the work of one invocation is limited.
  for (std::uint32_t half_space = 0; half_space < scene_.halfSpaceCount(); ++half_space)
  {
    programs_->half_spaces.set(LOCATION_HALF_SPACE, half_space);
    programs_->half_spaces.dispatch(groupsFor(std::size_t{states} * scene_.robotCount()));
  }
}

/// The program of the broad phase among links. Tables know no margins, and they need the states on the device.
const Program& GpuPairChecker::selfProgram(const Batch& batch)
{
  const std::size_t variables = batch.poses.boundVariables();
  if (!self_with_tables_ || !proofs_.haveTables() || batch.margins || variables == 0)
    return programs_->self;
  self_with_tables_->set(LOCATION_VARIABLE_COUNT, static_cast<std::uint32_t>(variables));
  return *self_with_tables_;
}

/// The queries with the most hits run first, whether they are about the world or about other links.
void GpuPairChecker::findCandidates(const Batch& batch, std::uint32_t states)
{
  if (proofs_.exist())
    proofs_.bind();
  const Program& self = selfProgram(batch);
  for (const Program* program : {&programs_->spheres, &programs_->world, &self, &programs_->roots})
  {
    program->set(LOCATION_STATE_COUNT, states);
    program->set(LOCATION_ROBOT_COUNT, scene_.robotCount());
  }
  spheres_.reserve(std::size_t{states} * scene_.robotCount() * TexelBuffer::kTexelBytes);
  if (!queries_.self.empty())
  {
    spheres_.buffer().bindStorage(BINDING_A);
    programs_->spheres.dispatch(groupsFor(std::size_t{states} * scene_.robotCount()));
  }
  spheres_.bindTexture(UNIT_SPHERES);
  lists_.candidates.buffer().bindStorage(BINDING_B);
  programs_->world.set(LOCATION_WORLD_COUNT, scene_.worldCount());
  const auto query = [&](const Program& program, const TexelBuffer& list, std::size_t begin, std::size_t end)
  {
    if (begin == end)
      return;
    list.bindTexture(UNIT_QUERIES);
    program.set(LOCATION_CANDIDATE_CAPACITY, lists_.capacity.candidates);
    program.set(LOCATION_FIRST_QUERY, static_cast<std::uint32_t>(begin));
    program.set(LOCATION_QUERY_COUNT, static_cast<std::uint32_t>(end - begin));
    program.dispatch(groupsFor(states * (end - begin)));
  };
  query(self, self_queries_, 0, queries_.hot_self);
  query(programs_->world, world_queries_, 0, queries_.hot_world);
  query(self, self_queries_, queries_.hot_self, queries_.self.size());
  query(programs_->world, world_queries_, queries_.hot_world, queries_.world.size());
}

void GpuPairChecker::testRoots()
{
  arguments_.prepare(COUNTER_CANDIDATES, lists_.capacity.candidates, GROUP_SIZE, COUNTER_SCRATCH);
  programs_->roots.set(LOCATION_CANDIDATE_CAPACITY, lists_.capacity.candidates);
  programs_->roots.set(LOCATION_ROOT_PAIR_CAPACITY, lists_.capacity.root_pairs);
  programs_->roots.set(LOCATION_SOLID_NODES, scene_.solidNodes());
  scene_.components().bindStorage(BINDING_C);
  lists_.root_pairs.buffer().bindStorage(BINDING_A);
  programs_->roots.dispatchIndirect(lists_.counters, ArgumentsKernel::argumentsOffset());
}

/// The balls of covers decide most pairs. The others become entries of the traversals.
void GpuPairChecker::proveRootPairs()
{
  arguments_.prepare(COUNTER_ROOT_PAIRS, lists_.capacity.root_pairs, GROUP_SIZE, COUNTER_SCRATCH);
  proofs_program_.set(LOCATION_ROBOT_COUNT, scene_.robotCount());
  proofs_program_.set(LOCATION_ROOT_PAIR_CAPACITY, lists_.capacity.root_pairs);
  proofs_program_.set(LOCATION_SOLID_NODES, scene_.solidNodes());
  proofs_program_.set(LOCATION_HAS_COVERS, proofs_.exist() ? 1U : 0U);
  lists_.mesh_entries.buffer().bindStorage(BINDING_B);
  lists_.solid_entries.buffer().bindStorage(BINDING_D);
  proofs_program_.dispatchIndirect(lists_.counters, ArgumentsKernel::argumentsOffset());
}

TraversalTask GpuPairChecker::task(bool solids, bool padded) const
{
  return {solids, padded, scene_.tolerance(), scene_.depthBound()};
}

/// Solids first, because their collisions are cheaper to find.
void GpuPairChecker::traverse(bool padded)
{
  if (scene_.solidNodes() != 0)
    traversal_->start(lists_, task(true, padded));
  traversal_->start(lists_, task(false, padded));
}

/// Tests whether a mesh or a primitive is inside a mesh. testRoots has already tested the inside of primitives.
/// `solids`: the pairs with a primitive.
void GpuPairChecker::testContainment(bool solids)
{
  if (!scene_.hasMeshSolids() || (solids && scene_.solidNodes() == 0))
    return;
  const std::uint32_t counter = solids ? COUNTER_SOLID_ENTRIES : COUNTER_MESH_ENTRIES;
  arguments_.prepare(counter, lists_.capacity.root_pairs, GROUP_SIZE, COUNTER_SCRATCH);
  inside_program_.set(LOCATION_IN_COUNTER, counter);
  inside_program_.set(LOCATION_IN_CAPACITY, lists_.capacity.root_pairs);
  (solids ? lists_.solid_entries : lists_.mesh_entries).bindTexture(UNIT_ENTRIES);
  scene_.components().bindStorage(BINDING_C);
  scene_.leafOrder().bindStorage(BINDING_A);
  scene_.triangleRoles().bindStorage(BINDING_B);
  inside_program_.dispatchIndirect(lists_.counters, ArgumentsKernel::argumentsOffset());
}
}  // namespace gpu_planning_scene::core
