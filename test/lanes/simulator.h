#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "lanes/command_queue.h"
#include "lanes/host.h"

namespace lanes
{
/// The kinds of access that a memory barrier of OpenGL orders. The values are the bits of glMemoryBarrier.
enum BarrierBit : std::uint32_t
{
  TextureFetch = 0x8,
  Command = 0x40,
  BufferUpdate = 0x200,
  ShaderStorage = 0x2000
};

/// A block of device memory, with the history of each 32-bit word.
struct Block
{
  /// The last accesses of a word by shaders. Dispatches are numbered from 1 on; 0 means never.
  struct Word
  {
    std::uint32_t written_in, written_by;  // dispatch; lane, across all groups
    std::uint32_t read_in, read_by;
    std::uint32_t before;  // the value at the beginning of the dispatch that wrote last
    bool known;            // the word has ever been written
    bool written_atomically;
    bool read_by_several;
  };
  explicit Block(std::size_t size);
  std::size_t bytes = 0;
  std::size_t count = 0;  // words
  std::unique_ptr<std::uint32_t[], void (*)(void*)> values;
  std::unique_ptr<Word[], void (*)(void*)> history;
};

/// Runs kernels on a simulated device. Each invocation is a fiber; a seeded scheduler switches between fibers at their
/// accesses to memory. Reports every access that OpenGL leaves undefined. Own method, after the vector clocks of race
/// detectors (C. Flanagan, S. N. Freund: FastTrack, 2009): the only orders in a dispatch are those of one lane and of
/// barriers in a work group, so the last accesses of a word suffice.
class Simulator : private Memory
{
 public:
  /// A program of the device: a compiled kernel, and a name for messages.
  struct Program
  {
    Kernel* kernel = nullptr;
    void (*main)() = nullptr;
    std::string name;
    /// The program tests the device's arithmetic. It then finds no fault: sums are rounded to nearest, and comparisons
    /// with NaN are false. A device that fails this test may not use the kernels that a run is to test.
    bool tests_arithmetic = false;
  };

  Simulator();
  ~Simulator();
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  /// The commands that were given to the device. The functions below that begin or end a measurement, or return
  /// faults, execute all of them first.
  CommandQueue& commands() { return commands_; }

  /// Also ends the state after a dispatch that hung.
  void setSeed(std::uint64_t seed);
  /// Uses IEEE arithmetic in place of the seed's.
  void useExactArithmetic() { chosen_arithmetic_ = false; }
  /// The work groups that are in flight at the same time. A GPU has hundreds, which share the entries of a queue.
  void setResidentGroups(std::size_t groups) { resident_groups_ = groups; }

  std::uint32_t addBlock(std::size_t bytes);
  void removeBlock(std::uint32_t id) { blocks_.erase(id); }
  Block& block(std::uint32_t id) { return *blocks_.at(id); }
  void bindStorage(std::uint32_t binding, std::uint32_t block, std::size_t offset, std::size_t bytes);
  void unbindStorage(std::uint32_t binding) { storage_.erase(binding); }
  void bindTexture(std::uint32_t unit, std::uint32_t block) { textures_[unit] = block; }

  void memoryBarrier(std::uint32_t bits);
  /// An access of a command (`bit`) to `bytes` bytes. Values are copied to or from `data`.
  void commandRead(std::uint32_t block, std::size_t offset, std::size_t bytes, void* data, BarrierBit bit);
  void commandWrite(std::uint32_t block, std::size_t offset, std::size_t bytes, const void* data);

  /// A dispatch that does not end is a fault. It is given up, and later dispatches do nothing, as on a lost device.
  void dispatch(const Program& program, std::uint32_t columns, std::uint32_t rows);

  /// The faults so far, each once.
  const std::set<std::string>& faults()
  {
    commands_.finish();
    return faults_;
  }
  void clearFaults()
  {
    commands_.finish();
    faults_.clear();
  }
  /// Adds a fault. In a dispatch, the program's name is put before it.
  void report(const std::string& what);
  std::uint64_t switches() const { return switches_; }

 private:
  struct Fiber;
  struct Group;
  struct Binding
  {
    std::uint32_t block = 0;
    std::size_t first = 0, count = 0;  // words
  };

  void load(std::uint32_t binding, std::uint64_t word, std::uint32_t count, std::uint32_t* values) override;
  void store(std::uint32_t binding, std::uint64_t word, std::uint32_t count, const std::uint32_t* values) override;
  std::uint32_t atomic(std::uint32_t binding, std::uint64_t word, AtomicOperation operation, std::uint32_t value,
                       std::uint32_t compared) override;
  void fetch(std::uint32_t unit, std::int64_t texel, std::uint32_t* values) override;
  void* shared(std::uint32_t offset, std::uint32_t place, SharedAccess access) override;
  void barrier(int site) override;
  void fault(const char* text) override;

  Block* find(std::uint32_t binding, std::uint64_t word, std::uint32_t count, std::size_t& at);
  const Variable* variable(std::uint32_t binding) const;
  std::string nameOf(std::uint32_t binding) const;
  void noteWrite(Block::Word& word, std::uint32_t value, bool atomically, std::uint32_t binding);
  bool covered(std::uint32_t dispatch, std::uint32_t bit) const;
  void chooseFreedoms();
  void countAccess();
  void maybeSwitch();
  void startGroup(std::uint32_t number, std::uint32_t columns, std::uint32_t rows);
  bool release(Group& group);

  CommandQueue commands_;
  std::map<std::uint32_t, std::unique_ptr<Block>> blocks_;
  std::map<std::uint32_t, Binding> storage_;
  std::map<std::uint32_t, std::uint32_t> textures_, texture_blocks_;
  std::map<std::uint32_t, std::uint32_t> covered_;  // bit: the last dispatch before the last barrier with this bit
  std::uint32_t next_id_ = 1;
  std::uint32_t dispatch_ = 0;
  Run run_;
  bool chosen_arithmetic_ = true;
  std::size_t resident_groups_ = 3;
  std::mt19937_64 random_{1};
  std::set<std::string> faults_;
  std::uint64_t switches_ = 0;
  bool hangs_ = false;
  std::uint32_t accesses_after_fault_ = 0;  // of the current dispatch

  const Program* program_ = nullptr;
  std::vector<std::unique_ptr<Fiber>> fibers_, idle_;
  std::vector<std::unique_ptr<Group>> groups_;
  Fiber* running_ = nullptr;
  std::uint32_t switch_one_in_ = 1;
  int order_ = 0;
};
}  // namespace lanes
