#include "collision/cpu/lanes/decision_tally.h"

#include <algorithm>
#include <chrono>
#include <numeric>

// Each thread has a tally of its own, which is added to the totals when the tally ends or before a report. One block in
// kTimedBlocks is timed; its times stand for the others. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint64_t kTimedBlocks = 64;  // one block of this many is timed, because reading the clock takes time
constexpr std::array<const char*, lanes::kStages> kNames = {"joint tables", "enclosing balls and boxes",
                                                            "8 balls per shape", "32 balls per shape",
                                                            "exact tests of the other pairs"};
}  // namespace

std::uint64_t steadyNanoseconds()
{
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
          .count());
}

void DecisionTotals::add(const DecisionCounts& counts)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t s = 0; s < lanes::kStages; ++s)
  {
    sum_.states[s] += counts.states[s];
    sum_.nanoseconds[s] += counts.nanoseconds[s];
  }
  sum_.timed_states += counts.timed_states;
}

std::vector<DecidedStates> DecisionTotals::report(std::uint64_t checked) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<DecidedStates> decided;
  const double timed = static_cast<double>(std::max<std::uint64_t>(1, sum_.timed_states));
  for (std::size_t s = 0; s < lanes::kStages; ++s)
    if (sum_.states[s] != 0 || sum_.nanoseconds[s] != 0)
      decided.push_back({kNames[s], sum_.states[s], static_cast<double>(sum_.nanoseconds[s]) / timed});
  const std::uint64_t alone = checked - std::accumulate(sum_.states.begin(), sum_.states.end(), std::uint64_t{0});
  if (alone != 0)
    decided.push_back({"the exact checker alone", alone, 0.0});
  return decided;
}

void DecisionTally::begin(lanes::Block& block)
{
  block.clock = totals_ && ++blocks_ % kTimedBlocks == 0 ? &steadyNanoseconds : nullptr;
}

void DecisionTally::add(const lanes::Block& block, std::size_t count, std::uint64_t exact_nanoseconds)
{
  for (std::size_t lane = 0; lane < count; ++lane)
    ++counts_.states[static_cast<std::size_t>(block.stage[lane])];
  if (!block.clock)
    return;
  counts_.timed_states += count;
  for (std::size_t s = 0; s < lanes::kStages; ++s)
    counts_.nanoseconds[s] += block.nanoseconds[s];
  counts_.nanoseconds[static_cast<std::size_t>(lanes::Stage::ExactPairs)] += exact_nanoseconds;
}

void DecisionTally::flush()
{
  if (totals_)
    totals_->add(counts_);
  counts_ = {};
}
}  // namespace gpu_planning_scene::core
