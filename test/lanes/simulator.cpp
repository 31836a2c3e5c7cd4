#include "lanes/simulator.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <boost/context/fiber.hpp>
#include <boost/context/fixedsize_stack.hpp>

namespace lanes
{
namespace
{
constexpr std::size_t kStackBytes = std::size_t{512} * 1024;
/// An invocation with more accesses to memory than this hangs. The loops of a shader have at most INVOCATION_ITERATIONS
/// iterations, and an iteration has fewer than 64 accesses.
constexpr std::uint32_t kMostAccesses = 4'000'000;
/// A dispatch with more accesses than this after the first fault is given up: a fault may make it as large as the
/// largest number of work groups.
constexpr std::uint32_t kMostAccessesAfterFault = 50'000;

std::string text(std::uint64_t number)
{
  return std::to_string(number);
}
}  // namespace

Block::Block(std::size_t size)
  : bytes(size),
    count((size + 3) / 4),
    values(static_cast<std::uint32_t*>(std::calloc(count, sizeof(std::uint32_t))), std::free),
    history(static_cast<Word*>(std::calloc(count, sizeof(Word))), std::free)
{
}

struct Simulator::Group
{
  struct Place  // of shared memory
  {
    int write_epoch = -1, read_epoch = -1;
    std::uint32_t written_by = 0, read_by = 0;
    bool written_atomically = false, read_by_several = false, read_atomically = false;
  };
  std::uint32_t number = 0;
  int epoch = 0;  // barriers that the group has passed
  std::vector<std::unique_ptr<Fiber>> lanes;
  std::vector<Fiber*> ready;  // the lanes that have not finished and wait at no barrier, in the order of `lanes`
  std::size_t finished = 0, waiting = 0;
  std::vector<char> shared;
  std::map<std::uint32_t, std::vector<Place>> places;  // by offset of the variable
};

struct Simulator::Fiber
{
  Lane lane;
  Group* group = nullptr;
  void (*main)() = nullptr;
  bool started = false;  // main() has begun and has not ended
  bool finished = false;
  std::uint32_t accesses = 0;
  int barrier = 0;  // the barrier at which the lane waits; 0: none
  std::uint32_t id = 0;
  boost::context::fiber context, scheduler;

  Fiber()
    : context(std::allocator_arg, boost::context::fixedsize_stack(kStackBytes),
              [this](boost::context::fiber&& from)
              {
                scheduler = std::move(from);
                while (main)
                {
                  started = true;
                  main();
                  started = false;
                  finished = true;
                  pause();
                }
                return std::move(scheduler);
              })
  {
  }
  /// A lane that hangs is unwound by the destructor of its context.
  ~Fiber()
  {
    main = nullptr;
    if (context && !started)
      resume();
  }
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;
  void resume() { context = std::move(context).resume(); }
  void pause() { scheduler = std::move(scheduler).resume(); }
};

Simulator::Simulator() = default;
Simulator::~Simulator() = default;

void Simulator::setSeed(std::uint64_t seed)
{
  commands_.finish();
  commands_.setSeed(seed);
  hangs_ = false;
  random_.seed(seed);
  run_.random = seed * 0x9e3779b97f4a7c15ULL + 1;
}

std::uint32_t Simulator::addBlock(std::size_t bytes)
{
  blocks_[next_id_] = std::make_unique<Block>(bytes);
  return next_id_++;
}

void Simulator::bindStorage(std::uint32_t binding, std::uint32_t block, std::size_t offset, std::size_t bytes)
{
  storage_[binding] = {block, offset / 4, bytes / 4};
}

void Simulator::memoryBarrier(std::uint32_t bits)
{
  for (const BarrierBit bit : {TextureFetch, Command, BufferUpdate, ShaderStorage})
    if (bits & bit)
      covered_[bit] = dispatch_;
}

bool Simulator::covered(std::uint32_t dispatch, std::uint32_t bit) const
{
  if (dispatch == 0)
    return true;
  const auto found = covered_.find(bit);
  return found != covered_.end() && dispatch <= found->second;
}

void Simulator::commandRead(std::uint32_t id, std::size_t offset, std::size_t bytes, void* data, BarrierBit bit)
{
  Block& from = block(id);
  if (offset + bytes > from.bytes)
    return report("a command reads beyond the end of a buffer");
  for (std::size_t i = offset / 4; i < (offset + bytes + 3) / 4; ++i)
    if (!covered(from.history[i].written_in, bit))
      report(std::string("a command reads what a dispatch wrote, without the memory barrier ") +
             (bit == Command ? "GL_COMMAND_BARRIER_BIT" : "GL_BUFFER_UPDATE_BARRIER_BIT"));
  std::memcpy(data, reinterpret_cast<const char*>(from.values.get()) + offset, bytes);
}

void Simulator::commandWrite(std::uint32_t id, std::size_t offset, std::size_t bytes, const void* data)
{
  Block& to = block(id);
  if (offset + bytes > to.bytes)
    return report("a command writes beyond the end of a buffer");
  for (std::size_t i = offset / 4; i < (offset + bytes + 3) / 4; ++i)
  {
    Block::Word& word = to.history[i];
    if (!covered(word.written_in, BufferUpdate))
      report("a command overwrites what a dispatch wrote, without GL_BUFFER_UPDATE_BARRIER_BIT");
    word = {};
    word.known = true;
  }
  std::memcpy(reinterpret_cast<char*>(to.values.get()) + offset, data, bytes);
}

void Simulator::report(const std::string& what)
{
  faults_.insert(program_ ? program_->name + ": " + what : what);
}

void Simulator::fault(const char* what)
{
  report(what);
}

const Variable* Simulator::variable(std::uint32_t binding) const
{
  const Kernel& kernel = *program_->kernel;
  for (std::uint32_t i = 0; i < kernel.variable_count; ++i)
    if (kernel.variables[i].kind == Variable::StorageBlock && kernel.variables[i].place == binding)
      return &kernel.variables[i];
  return nullptr;
}

std::string Simulator::nameOf(std::uint32_t binding) const
{
  return variable(binding)->name;
}

Block* Simulator::find(std::uint32_t binding, std::uint64_t word, std::uint32_t count, std::size_t& at)
{
  const auto bound = storage_.find(binding);
  if (bound == storage_.end() || blocks_.find(bound->second.block) == blocks_.end())
  {
    report(nameOf(binding) + " has no buffer");
    return nullptr;
  }
  if (word + count > bound->second.count)
  {
    report("an access beyond the end of " + nameOf(binding));
    return nullptr;
  }
  at = bound->second.first + word;
  return blocks_.at(bound->second.block).get();
}

void Simulator::load(std::uint32_t binding, std::uint64_t first, std::uint32_t count, std::uint32_t* values)
{
  maybeSwitch();
  std::size_t at = 0;
  Block* block = find(binding, first, count, at);
  std::fill_n(values, count, 0);
  if (!block)
    return;
  const Variable& from = *variable(binding);
  if (from.flags & kWriteonly)
    report(nameOf(binding) + " is writeonly, but is read");
  for (std::uint32_t i = 0; i < count; ++i)
  {
    Block::Word& word = block->history[at + i];
    values[i] = block->values[at + i];
    if (!word.known)
      report("a read of " + nameOf(binding) + " where nothing was written");
    if (word.written_in == dispatch_ && word.written_by != running_->id)
    {
      if (!(from.flags & kCoherent) || !word.written_atomically)
        report("a race: a lane reads what another lane writes to " + nameOf(binding) + " in the same dispatch");
      else if (random_() & 1U)
        values[i] = word.before;  // a coherent read may be older than the atomic write of another lane
    }
    else if (word.written_in != dispatch_ && !covered(word.written_in, ShaderStorage))
      report(nameOf(binding) + " is read as storage without GL_SHADER_STORAGE_BARRIER_BIT after it was written");
    if (!(from.flags & kCoherent))
    {
      word.read_by_several = word.read_in == dispatch_ && (word.read_by_several || word.read_by != running_->id);
      word.read_in = dispatch_;
      word.read_by = running_->id;
    }
  }
}

void Simulator::noteWrite(Block::Word& word, std::uint32_t value, bool atomically, std::uint32_t binding)
{
  const bool other_wrote = word.written_in == dispatch_ && word.written_by != running_->id;
  if (other_wrote && !(atomically && word.written_atomically))
    report("a race: two lanes write to the same word of " + nameOf(binding));
  if (word.read_in == dispatch_ && (word.read_by_several || word.read_by != running_->id))
    report("a race: a lane writes what another lane reads from " + nameOf(binding) + " in the same dispatch");
  if (word.written_in != dispatch_ && !covered(word.written_in, ShaderStorage))
    report(nameOf(binding) + " is written without GL_SHADER_STORAGE_BARRIER_BIT after an earlier dispatch wrote it");
  if (word.read_in != dispatch_ && !covered(word.read_in, ShaderStorage))
    report(nameOf(binding) + " is written without GL_SHADER_STORAGE_BARRIER_BIT after an earlier dispatch read it");
  if (word.written_in != dispatch_)
    word.before = value;
  word.written_in = dispatch_;
  word.written_by = running_->id;
  word.written_atomically = atomically;
}

void Simulator::store(std::uint32_t binding, std::uint64_t first, std::uint32_t count, const std::uint32_t* values)
{
  maybeSwitch();
  std::size_t at = 0;
  Block* block = find(binding, first, count, at);
  if (!block)
    return;
  if (variable(binding)->flags & kReadonly)
    report(nameOf(binding) + " is readonly, but is written");
  for (std::uint32_t i = 0; i < count; ++i)
  {
    noteWrite(block->history[at + i], block->values[at + i], false, binding);
    block->history[at + i].known = true;
    block->values[at + i] = values[i];
  }
}

std::uint32_t Simulator::atomic(std::uint32_t binding, std::uint64_t first, AtomicOperation operation,
                                std::uint32_t value, std::uint32_t compared)
{
  maybeSwitch();
  std::size_t at = 0;
  Block* block = find(binding, first, 1, at);
  if (!block)
    return 0;
  if (!block->history[at].known)
    report("an atomic operation on " + nameOf(binding) + " where nothing was written");
  const std::uint32_t before = block->values[at];
  noteWrite(block->history[at], before, true, binding);
  const auto result = [&]
  {
    switch (operation)
    {
      case AtomicOperation::Add:
        return before + value;
      case AtomicOperation::Or:
        return before | value;
      case AtomicOperation::Max:
        return std::max(before, value);
      case AtomicOperation::Exchange:
        return value;
      case AtomicOperation::CompareSwap:
        break;
    }
    return before == compared ? value : before;
  };
  block->values[at] = result();
  return before;
}

void Simulator::fetch(std::uint32_t unit, std::int64_t texel, std::uint32_t* values)
{
  std::fill_n(values, 4, 0);
  const auto bound = textures_.find(unit);
  if (bound == textures_.end() || blocks_.find(bound->second) == blocks_.end())
    return report("texture unit " + text(unit) + " has no buffer");
  Block& block = *blocks_.at(bound->second);
  if (texel < 0 || (texel + 1) * 16 > static_cast<std::int64_t>(block.bytes))
    return report("a fetch beyond the end of texture unit " + text(unit));
  for (int i = 0; i < 4; ++i)
  {
    Block::Word& word = block.history[texel * 4 + i];
    values[i] = block.values[texel * 4 + i];
    if (word.written_in == dispatch_)
      report("a race: a fetch from texture unit " + text(unit) + " of what the same dispatch writes");
    else if (!covered(word.written_in, TextureFetch))
      report("texture unit " + text(unit) + " is read without GL_TEXTURE_FETCH_BARRIER_BIT after it was written");
    word.read_by_several = word.read_in == dispatch_ && (word.read_by_several || word.read_by != running_->id);
    word.read_in = dispatch_;
    word.read_by = running_->id;
  }
}

void* Simulator::shared(std::uint32_t offset, std::uint32_t place, SharedAccess access)
{
  if (access == SharedAccess::Read || access == SharedAccess::Atomic || place == kNoPlace)
    maybeSwitch();
  if (place == kNoPlace)
    return &running_->group->shared[offset];
  const Kernel& kernel = *program_->kernel;
  const Variable* of = nullptr;
  for (std::uint32_t i = 0; i < kernel.variable_count; ++i)
  {
    const Variable& candidate = kernel.variables[i];
    if (candidate.kind == Variable::SharedMemory && candidate.place <= offset &&
        offset < candidate.place + candidate.size * candidate.count)
      of = &candidate;
  }
  assert(of != nullptr);  // the translated shader accesses shared memory only through its variables
  Group& group = *running_->group;
  std::vector<Group::Place>& places = group.places[of->place];
  places.resize(of->count);
  Group::Place& at = places[place];
  const std::uint32_t lane = running_->lane.local;
  const bool other_wrote = at.write_epoch == group.epoch && at.written_by != lane;
  const bool other_read = at.read_epoch == group.epoch && (at.read_by_several || at.read_by != lane);
  const bool is_atomic = access == SharedAccess::Atomic;
  if (access != SharedAccess::Write && access != SharedAccess::WriteSame && at.write_epoch < 0)
    report(std::string("a read of shared ") + of->name + " where the group wrote nothing");
  if (other_wrote && !(is_atomic && at.written_atomically) && access != SharedAccess::WriteSame)
    report(std::string("a race on shared ") + of->name + " without a barrier after a write");
  if (access != SharedAccess::Read && access != SharedAccess::WriteSame && other_read &&
      !(is_atomic && at.read_atomically))
    report(std::string("a race on shared ") + of->name + " without a barrier after a read");
  if (access == SharedAccess::Read)
  {
    at.read_by_several = at.read_epoch == group.epoch && (at.read_by_several || at.read_by != lane);
    at.read_epoch = group.epoch;
    at.read_by = lane;
    at.read_atomically = false;
  }
  else
  {
    at.write_epoch = group.epoch;
    at.written_by = lane;
    at.written_atomically = is_atomic;
  }
  return &group.shared[offset];
}

void Simulator::barrier(int site)
{
  countAccess();
  running_->barrier = site;
  ++running_->group->waiting;
  running_->pause();
}

void Simulator::countAccess()
{
  accesses_after_fault_ += faults_.empty() ? 0 : 1;
  const bool lane_hangs = ++running_->accesses > kMostAccesses;
  if (!lane_hangs && accesses_after_fault_ <= kMostAccessesAfterFault)
    return;
  report(lane_hangs ? "the dispatch does not end: an invocation has more than " + text(kMostAccesses) + " accesses"
                    : "the dispatch is given up: it has more than " + text(kMostAccessesAfterFault) +
                          " accesses after a fault");
  hangs_ = true;
  running_->pause();
}

void Simulator::maybeSwitch()
{
  countAccess();
  if (switch_one_in_ == 0 || random_() % switch_one_in_ != 0)
    return;
  running_->pause();
}

/// Lets the lanes of a group go on after a barrier that all of them have reached.
bool Simulator::release(Group& group)
{
  if (group.waiting + group.finished < group.lanes.size())
    return false;
  if (group.waiting > 0)
  {
    int site = 0;
    for (const auto& lane : group.lanes)
      if (!lane->finished)
      {
        if (site != 0 && lane->barrier != site)
          report("lanes of one group wait at different barriers");
        site = lane->barrier;
      }
    if (group.finished > 0)
      report("some lanes of a group end, others wait at a barrier");
    for (const auto& lane : group.lanes)
    {
      lane->barrier = 0;
      if (!lane->finished)
        group.ready.push_back(lane.get());
    }
    group.waiting = 0;
    ++group.epoch;
  }
  return group.finished == group.lanes.size();
}

void Simulator::chooseFreedoms()
{
  constexpr std::uint32_t kSwitchOneIn[] = {1, 4, 32, 0};
  switch_one_in_ = kSwitchOneIn[random_() % 4];
  order_ = static_cast<int>(random_() % 3);
  run_.arithmetic = {};
  if (!chosen_arithmetic_)
    return;
  const auto choice = [&] { return static_cast<Arithmetic::Choice>(random_() % 3); };
  run_.arithmetic.rounding = static_cast<Arithmetic::Rounding>(random_() % 5);
  run_.arithmetic.contract = choice();
  run_.arithmetic.reorder = choice();
  run_.arithmetic.distribute = choice();
  run_.arithmetic.flush = choice();
  constexpr int kSteps[] = {0, 2, -2, Arithmetic::kRandomSteps};
  run_.arithmetic.steps = kSteps[random_() % 4];
  run_.arithmetic.nan_is_true = choice();
  if (!program_->tests_arithmetic)
    return;
  run_.arithmetic.rounding = Arithmetic::Rounding::Nearest;
  run_.arithmetic.nan_is_true = Arithmetic::Choice::Never;
}

void Simulator::startGroup(std::uint32_t number, std::uint32_t columns, std::uint32_t rows)
{
  const Kernel& kernel = *program_->kernel;
  auto group = std::make_unique<Group>();
  group->number = number;
  group->shared.resize(kernel.shared_bytes + 16);
  for (char& byte : group->shared)
    byte = static_cast<char>(random_());
  for (std::uint32_t i = 0; i < kernel.group_size; ++i)
  {
    if (idle_.empty())
      idle_.push_back(std::make_unique<Fiber>());
    std::unique_ptr<Fiber> fiber = std::move(idle_.back());
    idle_.pop_back();
    fiber->lane = {i, {number % columns, number / columns, 0}, {columns, rows, 1}, false};
    fiber->group = group.get();
    fiber->main = program_->main;
    fiber->finished = false;
    fiber->accesses = 0;
    fiber->barrier = 0;
    fiber->id = number * kernel.group_size + i;
    group->ready.push_back(fiber.get());
    group->lanes.push_back(std::move(fiber));
  }
  groups_.push_back(std::move(group));
}

void Simulator::dispatch(const Program& program, std::uint32_t columns, std::uint32_t rows)
{
  if (hangs_)
    return;
  if (columns * rows == 0)
    return;
  ++dispatch_;
  accesses_after_fault_ = 0;
  program_ = &program;
  run_.memory = this;
  program.kernel->run = &run_;
  chooseFreedoms();
  std::vector<std::uint32_t> pending(std::size_t{columns} * rows);
  for (std::size_t i = 0; i < pending.size(); ++i)
    pending[i] = static_cast<std::uint32_t>(i);
  std::shuffle(pending.begin(), pending.end(), random_);
  while (!pending.empty() || !groups_.empty())
  {
    while (!pending.empty() && groups_.size() < resident_groups_)
    {
      startGroup(pending.back(), columns, rows);
      pending.pop_back();
    }
    const std::size_t which = random_() % groups_.size();
    Group& group = *groups_[which];
    std::vector<Fiber*>& ready = group.ready;
    const std::size_t chosen = order_ == 0 ? 0 : order_ == 1 ? ready.size() - 1 : random_() % ready.size();
    running_ = ready[chosen];
    run_.lane = &running_->lane;
    running_->resume();
    ++switches_;
    if (hangs_)
    {
      groups_.clear();
      break;
    }
    if (running_->finished)
      ++group.finished;
    if (running_->finished || running_->barrier != 0)
      ready.erase(ready.begin() + static_cast<std::ptrdiff_t>(chosen));
    if (release(group))
    {
      for (auto& lane : group.lanes)
        idle_.push_back(std::move(lane));
      groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(which));
    }
  }
  program_ = nullptr;
}
}  // namespace lanes
