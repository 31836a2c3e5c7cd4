#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "collision/cpu/lanes/lane_model.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// States that each stage has decided, and the time of each stage in a sample of the states.
struct DecisionCounts
{
  std::array<std::uint64_t, lanes::kStages> states = {};
  std::array<std::uint64_t, lanes::kStages> nanoseconds = {};  // of the timed states
  std::uint64_t timed_states = 0;
};

/// The sum of the tallies of several threads. Thread-safe.
class DecisionTotals
{
 public:
  void add(const DecisionCounts& counts);

  /// The stages in their order, without stages that were not used. `checked`: the number of all states that the CPU has
  /// checked. The exact checker alone decided the states that no stage has counted.
  std::vector<DecidedStates> report(std::uint64_t checked) const;

 private:
  mutable std::mutex mutex_;
  DecisionCounts sum_;
};

/// The counts of one thread. A copy begins with no counts. The destructor adds the counts to the totals.
class DecisionTally
{
 public:
  DecisionTally() = default;
  DecisionTally(const DecisionTally& other) : totals_(other.totals_) {}
  DecisionTally& operator=(const DecisionTally&) = delete;
  ~DecisionTally() { flush(); }

  /// Sets the totals; without totals, nothing is counted.
  void countFor(std::shared_ptr<DecisionTotals> totals) { totals_ = std::move(totals); }
  /// Decides whether the next block is timed: its clock is set for every 64th block, and not for the first one, whose
  /// data is not in the cache.
  void begin(lanes::Block& block);
  /// Adds a block of `count` states. `exact_nanoseconds`: the time of the exact pair tests, if the block is timed.
  void add(const lanes::Block& block, std::size_t count, std::uint64_t exact_nanoseconds);
  /// Adds the counts to the totals.
  void flush();

 private:
  std::shared_ptr<DecisionTotals> totals_;
  DecisionCounts counts_;
  std::uint64_t blocks_ = 0;
};

/// Nanoseconds of a steady clock.
std::uint64_t steadyNanoseconds();
}  // namespace gpu_planning_scene::core
