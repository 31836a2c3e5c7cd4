#include "collision/gpu/gpu_pair_checker.h"

#include <algorithm>
#include <chrono>

#include "collision/gpu/part_limits.h"
#include "collision/gpu/problem/gpu_kinematics.h"
#include "collision/gpu/proofs/frame_check.h"
#include "gpu/float_arithmetic.h"
#include "gpu/gl_check.h"
#include "gpu_planning_scene/error.h"
#include "shader_constants.h"

// Queues all dispatches of a part without waiting: proofs and the kinematics of the states that they leave open, or
// else kinematics and broad phase; then root boxes, half-spaces, traversal and containment. If a list overflows, the
// device sets a counter, and the part is split and repeated. The traversal on the device follows Gress and Zachmann
// (2003); the queue of dispatches and the split are our own method.
namespace gpu_planning_scene::core
{
namespace
{
/// The order of queries is learned from at most this many states of a part.
constexpr std::size_t kMaxCounted = 16384;

constexpr std::size_t kFirstPart = 2048;

/// Byte offsets in the results of a part: counters, then verdicts.
struct AnswerOffsets
{
  explicit AnswerOffsets(std::size_t count)
    : verdict_bytes((count * sizeof(std::uint32_t) + Buffer::kStorageAlignment - 1) / Buffer::kStorageAlignment *
                    Buffer::kStorageAlignment),
      end(verdicts + verdict_bytes)
  {
  }
  std::size_t verdict_bytes;
  std::size_t verdicts = Buffer::kStorageAlignment;
  std::size_t end;
};
static_assert(COUNTER_WORDS * sizeof(std::uint32_t) <= Buffer::kStorageAlignment, "they lie before the verdicts");
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
    folder_(folder),
    plain_(folder, definitions_),
    inside_program_(folder, "traversal/containment.comp", definitions_),
    done_program_(folder, "common/batch_done.comp"),
    proofs_(folder, definitions_)
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
  proofs_.clear();
  scene_.selectPairs(problem);
  order_.setPairs(problem);
  margins_.setPairs(problem);
  prepare();
}

void GpuPairChecker::useProofs(const LaneScene& scene, GpuKinematics& kinematics)
{
  if (!float_fault_.empty())
    return;  // they would prove nothing
  proofs_.set(scene);
  if (const std::string fault = faultOfProofs(scene, kinematics); !fault.empty())
  {
    proofs_.clear();
    throw Error(fault);
  }
}

/// Places the frames of some states on the device, and compares them with the robot model.
std::string GpuPairChecker::faultOfProofs(const LaneScene& scene, GpuKinematics& kinematics)
{
  const std::vector<double> states = statesOfFrameCheck(*kinematics.robot());
  Buffer answers(kFrameCheckStates * sizeof(std::uint32_t));
  answers.clear(0, answers.size(), VERDICT_UNDECIDED);
  lists_.reserve(kFrameCheckStates, TexelBuffer::maxBytes());
  lists_.clearCounters();
  lists_.counters.bindStorage(BINDING_COUNTERS);
  answers.bindStorage(BINDING_VERDICTS);
  kinematics.setStates(states.data());
  kinematics.begin(0, kFrameCheckStates);
  proofs_.start({kFrameCheckStates, scene_.robotCount(), 0}, lists_);
  std::vector<std::uint32_t> verdicts(kFrameCheckStates);
  answers.read(verdicts.data(), verdicts.size() * sizeof(std::uint32_t));
  return findFrameFault(*kinematics.robot(), scene, states, proofs_.readFrames(kFrameCheckStates), verdicts);
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
  prepareTraversal(scene_.isPadded());
}

void GpuPairChecker::prepareMargins()
{
  if (!with_margins_)
    with_margins_.emplace(folder_, definitions_ + "#define MARGINS 1\n");
  if (!proofs_.exist())
    return prepareTraversal(true);
  try
  {
    proofs_.prepareMargins();
  }
  catch (const DeviceLost&)
  {
    throw;
  }
  catch (const Error&)  // the device does not compile them; trees decide all pairs
  {
    proofs_.clear();
  }
  prepareTraversal(true);
}

/// Compiles the programs of the traversals.
void GpuPairChecker::prepareTraversal(bool padded)
{
  for (const bool solids : {false, true})
    if (!solids || scene_.solidNodes() != 0)
      traversal_->prepare(task(solids, padded));
}

std::size_t GpuPairChecker::largestPart(const Work& work) const
{
  const std::size_t most = std::min(work.size.size(), work.poses.maxStates());
  return provesFirst(work) ? std::min(most, proofs_.maxStates()) : most;
}

void GpuPairChecker::check(PoseSource& source, PartSource& parts, const Margins* margins)
{
  work_ = {};
  if (scene_.robotCount() == 0)
    return bringFree(parts);
  const Work work{source, parts, margins, margins ? parts_with_margins_ : plain_parts_};
  if (margins)
    prepareMargins();
  programs_ = margins ? &*with_margins_ : &plain_;
  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  Part* running = nullptr;
  bool is_last = false;
  for (std::size_t i = 0; running || !is_last; ++i)
  {
    Part* next = nullptr;
    if (!is_last)
    {
      next = &parts_[i % 2];
      next->states = parts.take(largestPart(work));
      is_last = next->states.count == 0;
    }
    if (is_last)
      next = nullptr;
    else
      start(work, *next);
    if (running)
    {
      const std::size_t states = running->states.count;
      finish(work, *running);
      const Clock::time_point now = Clock::now();
      work.size.took(states, std::chrono::duration<double>(now - last).count());
      last = now;
    }
    running = next;
  }
  if (!provesFirst(work) && order_.endBatch(work_.states))
    writeQueries();
}

/// A robot without shapes hits nothing.
void GpuPairChecker::bringFree(PartSource& parts) const
{
  std::vector<std::uint32_t> verdicts;
  for (StateRange states = parts.take(max_states_); states.count != 0; states = parts.take(max_states_))
  {
    verdicts.assign(states.count, VERDICT_FREE);
    parts.bring(states, verdicts.data(), {});
  }
}

void GpuPairChecker::learnOrder(const std::uint32_t* verdicts, std::size_t count)
{
  const std::size_t stride = 1 + count / kMaxCounted;
  for (std::size_t i = 0; i < count; i += stride)
    if (isHit(verdicts[i]))
    {
      const auto [robot, other] = pairOf(verdicts[i]);
      order_.count(robot, other);
    }
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

void GpuPairChecker::finish(const Work& work, Part& part)
{
  if (fetch(work, part))
    return;
  const StateRange whole = part.states;
  if (whole.count == 1)
  {
    const std::uint32_t undecided = VERDICT_UNDECIDED;
    return work.parts.bring(whole, &undecided, {});
  }
  work.size.tooLarge(whole.count);
  const std::size_t half = whole.count / 2;
  for (const StateRange& states : {StateRange{whole.begin, half}, StateRange{whole.begin + half, whole.count - half}})
  {
    part.states = states;
    start(work, part);
    finish(work, part);
  }
}

bool GpuPairChecker::fetch(const Work& of, Part& part)
{
  const AnswerOffsets offsets(part.states.count);
  const std::uint32_t* words = part.fetched.wait();
  refuseLostContext();  // a reset may have left wrong verdicts behind
  if (words[COUNTER_OVERFLOW] != 0 || words[COUNTER_DONE] != part.serial)
    return false;
  GpuWork work;
  work.states = part.states.count;
  work.candidates = words[LIST_CANDIDATES + LIST_LENGTH];
  work.root_pairs = words[LIST_ROOT_PAIRS + LIST_LENGTH];
  work.traversed = std::size_t(words[LIST_MESH_ENTRIES + LIST_LENGTH]) + words[LIST_SOLID_ENTRIES + LIST_LENGTH];
  work_ += work;
  const std::uint32_t* const verdicts = words + offsets.verdicts / sizeof(std::uint32_t);
  if (!provesFirst(of))  // the proofs have an order of their own
    learnOrder(verdicts, part.states.count);
  of.parts.bring(part.states, verdicts, work);
  return true;
}

/// Starts all of a part's work without waiting for any of it.
void GpuPairChecker::start(const Work& work, Part& part)
{
  const AnswerOffsets offsets(part.states.count);
  part.answers.reserve(offsets.end);
  // The proofs write each verdict, so none is left if their dispatch is lost.
  part.answers.clear(offsets.verdicts, offsets.verdict_bytes, provesFirst(work) ? VERDICT_UNDECIDED : VERDICT_FREE);
  lists_.reserve(part.states.count, TexelBuffer::maxBytes());
  lists_.clearCounters();
  poses_.reserve(part.states.count * scene_.robotCount() * POSE_TEXELS * TexelBuffer::kTexelBytes);
  work.poses.begin(part.states.begin, part.states.count);
  if (work.margins)
    margins_.write(*work.margins, part.states.begin, part.states.count);
  scene_.bind();
  lists_.counters.bindStorage(BINDING_COUNTERS);
  part.answers.bindStorage(BINDING_VERDICTS, offsets.verdicts, offsets.verdict_bytes);

  const auto states = static_cast<std::uint32_t>(part.states.count);
  if (provesFirst(work))
  {
    proofs_.start({states, scene_.robotCount(), static_cast<std::uint32_t>(work.margins ? work.margins->width : 0)},
                  lists_);
    work.poses.placeOpenStates(poses_, lists_);
  }
  else
  {
    lists_.open_states.bindStorage(BINDING_OPEN_STATES);
    work.poses.place(poses_);
  }
  poses_.bindTexture(UNIT_ROBOT_POSES);
  for (const Program* program :
       {&programs_->spheres, &programs_->world, &programs_->self, &programs_->roots, &programs_->half_spaces})
  {
    program->set(LOCATION_STATE_COUNT, states);
    program->set(LOCATION_ROBOT_COUNT, scene_.robotCount());
    if (work.margins && program != &programs_->self)
      program->set(LOCATION_MARGIN_COUNT, static_cast<std::uint32_t>(work.margins->width));
  }
  if (!provesFirst(work))
    findCandidates(states);
  testRoots();
  testHalfSpaces();
  traverse(scene_.isPadded() || work.margins);
  testContainment();
  part.serial = serial_ = std::max(1U, serial_ + 1U);  // 0 is the value of a cleared counter
  done_program_.set(LOCATION_SERIAL, part.serial);
  done_program_.set(LOCATION_HAS_QUEUES, traversal_->hasQueues() ? 1U : 0U);
  done_program_.set(LOCATION_ROOT_PAIR_CAPACITY, lists_.capacity.root_pairs);
  done_program_.set(LOCATION_ENTRY_CAPACITY, lists_.capacity.node_pairs);
  done_program_.dispatch(1);
  part.answers.copyFrom(lists_.counters, COUNTER_WORDS * sizeof(std::uint32_t));
  part.fetched.begin(part.answers, offsets.end);
  checkGl("a batch");
}

/// Proofs need the states on the device.
bool GpuPairChecker::provesFirst(const Work& work) const
{
  return proofs_.exist() && work.poses.boundVariables() != 0;
}

/// The queries with the most hits run first, whether they are about the world or about other links.
void GpuPairChecker::findCandidates(std::uint32_t states)
{
  spheres_.reserve(std::size_t{states} * scene_.robotCount() * TexelBuffer::kTexelBytes);
  if (!queries_.self.empty())
  {
    spheres_.buffer().bindStorage(BINDING_A);
    programs_->spheres.dispatch(groupsFor(std::size_t{states} * scene_.robotCount()));
  }
  spheres_.bindTexture(UNIT_SPHERES);
  lists_.candidates.buffer().bindStorage(BINDING_B);
  programs_->world.set(LOCATION_WORLD_COUNT, scene_.worldCount());
  programs_->world.set(LOCATION_HALF_SPACE_COUNT, scene_.halfSpaceCount());
  scene_.halfSpaces().bindStorage(BINDING_C);
  scene_.halfSpacePairs().bindStorage(BINDING_D);
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
  query(programs_->self, self_queries_, 0, queries_.hot_self);
  query(programs_->world, world_queries_, 0, queries_.hot_world);
  query(programs_->self, self_queries_, queries_.hot_self, queries_.self.size());
  query(programs_->world, world_queries_, queries_.hot_world, queries_.world.size());
}

void GpuPairChecker::testRoots()
{
  const Program& program = programs_->roots;
  program.set(LOCATION_WORLD_COUNT, scene_.worldCount());
  program.set(LOCATION_CANDIDATE_CAPACITY, lists_.capacity.candidates);
  program.set(LOCATION_ROOT_PAIR_CAPACITY, lists_.capacity.root_pairs);
  program.set(LOCATION_SOLID_NODES, scene_.solidNodes());
  lists_.candidates.bindTexture(UNIT_CANDIDATES);
  scene_.components().bindStorage(BINDING_C);
  lists_.root_pairs.buffer().bindStorage(BINDING_A);
  lists_.mesh_entries.buffer().bindStorage(BINDING_B);
  lists_.solid_entries.buffer().bindStorage(BINDING_D);
  program.dispatchIndirect(lists_.counters, LIST_CANDIDATES * sizeof(std::uint32_t));
  lists_.root_pairs.bindTexture(UNIT_ROOT_PAIRS);
}

void GpuPairChecker::testHalfSpaces()
{
  if (scene_.halfSpaceCount() == 0)
    return;
  const Program& program = programs_->half_spaces;
  program.set(LOCATION_WORLD_COUNT, scene_.worldCount());
  program.set(LOCATION_CANDIDATE_CAPACITY, lists_.capacity.candidates);
  scene_.halfSpaces().bindStorage(BINDING_C);
  program.dispatchIndirect(lists_.counters, LIST_CANDIDATES * sizeof(std::uint32_t));
}

TraversalTask GpuPairChecker::task(bool solids, bool padded) const
{
  return {solids, padded, scene_.depthBound()};
}

/// Solids first, because their collisions are cheaper to find.
void GpuPairChecker::traverse(bool padded)
{
  if (scene_.solidNodes() != 0)
    traversal_->start(lists_, task(true, padded));
  traversal_->start(lists_, task(false, padded));
}

/// Tests whether a mesh or a primitive is inside a mesh. testRoots has already tested the inside of primitives.
void GpuPairChecker::testContainment()
{
  if (!scene_.hasMeshSolids())
    return;
  inside_program_.set(LOCATION_ROOT_PAIR_CAPACITY, lists_.capacity.root_pairs);
  scene_.components().bindStorage(BINDING_C);
  scene_.leafOrder().bindStorage(BINDING_A);
  scene_.triangleRoles().bindStorage(BINDING_B);
  inside_program_.dispatchIndirect(lists_.counters, LIST_ROOT_PAIRS * sizeof(std::uint32_t));
}
}  // namespace gpu_planning_scene::core
