#pragma once

#include <cstdint>

// The interface between the simulator and a kernel, which is compiled into a library of its own.
namespace lanes
{
/// The freedoms that OpenGL and docs/error_bounds.md leave to float32 arithmetic. A seed chooses among them.
struct Arithmetic
{
  enum class Rounding
  {
    Nearest,
    Up,
    Down,
    ToZero,
    Random
  };
  enum class Choice
  {
    Never,
    Always,
    Random
  };
  Rounding rounding = Rounding::Nearest;
  Choice contract = Choice::Never;    ///< computes a product and a sum with one rounding
  Choice reorder = Choice::Never;     ///< adds the terms of a sum in another order
  Choice distribute = Choice::Never;  ///< multiplies the terms of a sum one by one
  Choice flush = Choice::Never;       ///< turns denormals into 0
  /// Steps by which sqrt, inversesqrt and division miss the nearest float: -2 to 2, or kRandomSteps.
  int steps = 0;
  Choice nan_is_true = Choice::Never;  ///< the result of a comparison with NaN
  static constexpr int kRandomSteps = 3;
};

/// The invocation that runs.
struct Lane
{
  std::uint32_t local = 0;
  std::uint32_t group[3] = {};
  std::uint32_t groups[3] = {};
  bool precise = false;  ///< a `precise` expression is being computed
};

enum class SharedAccess
{
  Read,
  Write,
  WriteSame,  ///< stores the value that is there
  Atomic
};

enum class AtomicOperation
{
  Add,
  Or,
  Max,
  Exchange,
  CompareSwap
};

constexpr std::uint32_t kNoPlace = ~0U;

/// The memory of the simulated device. `binding` is that of a storage buffer; `word` counts its 32-bit words.
class Memory
{
 public:
  virtual void load(std::uint32_t binding, std::uint64_t word, std::uint32_t count, std::uint32_t* values) = 0;
  virtual void store(std::uint32_t binding, std::uint64_t word, std::uint32_t count, const std::uint32_t* values) = 0;
  /// `compared`: CompareSwap writes only if the word has this value.
  virtual std::uint32_t atomic(std::uint32_t binding, std::uint64_t word, AtomicOperation operation,
                               std::uint32_t value, std::uint32_t compared = 0) = 0;
  virtual void fetch(std::uint32_t unit, std::int64_t texel, std::uint32_t* values) = 0;
  /// The address of an element of shared memory, `place` of its variable. kNoPlace: the access does not count.
  virtual void* shared(std::uint32_t offset, std::uint32_t place, SharedAccess access) = 0;
  virtual void barrier(int site) = 0;
  virtual void fault(const char* text) = 0;

 protected:
  ~Memory() = default;
};

/// The state of a running kernel: its memory, its lane, its arithmetic and its random numbers.
struct Run
{
  Memory* memory = nullptr;
  Lane* lane = nullptr;
  Arithmetic arithmetic;
  std::uint64_t random = 1;

  /// A pseudorandom number (G. Marsaglia: Xorshift RNGs, 2003).
  std::uint32_t next()
  {
    random ^= random << 13U;
    random ^= random >> 7U;
    random ^= random << 17U;
    return static_cast<std::uint32_t>(random >> 32U);
  }
  bool choose(Arithmetic::Choice choice)
  {
    return choice == Arithmetic::Choice::Always || (choice == Arithmetic::Choice::Random && (next() & 1U) != 0);
  }
};

/// A variable of a kernel's storage blocks, uniforms or shared memory.
struct Variable
{
  enum Kind : std::uint32_t
  {
    StorageBlock,
    Uniform,
    SharedMemory
  };
  Kind kind;
  std::uint32_t place;  ///< binding, location, or offset in shared memory
  std::uint32_t size;   ///< shared memory: bytes of an element
  std::uint32_t count;  ///< shared memory: elements
  std::uint32_t flags;  ///< storage blocks: kCoherent, ...
  const char* name;
  void* value;  ///< uniforms
};
constexpr std::uint32_t kCoherent = 1;
constexpr std::uint32_t kReadonly = 2;
constexpr std::uint32_t kWriteonly = 4;

/// Everything that the simulator must know about a kernel.
struct Kernel
{
  std::uint32_t group_size = 1;
  std::uint32_t shared_bytes = 0;
  std::uint32_t variable_count = 0;
  Variable variables[64];
  Run* run = nullptr;
};
}  // namespace lanes
