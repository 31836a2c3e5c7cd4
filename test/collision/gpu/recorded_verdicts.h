#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "collision/gpu/part_source.h"

namespace gpu_planning_scene::core
{
/// Hands states out, and records their verdicts and the sizes of the parts.
class RecordedVerdicts : public PartSource
{
 public:
  explicit RecordedVerdicts(std::size_t count) : words(count), brought(count, 0) {}

  StateRange take(std::size_t most) override
  {
    const StateRange next{taken_, std::min(most, words.size() - taken_)};
    taken_ = next.end();
    return next;
  }
  void copy(const StateRange& /*states*/, double* /*to*/) override
  {
    throw std::logic_error("the source of the poses has the states");
  }
  void bring(const StateRange& states, const std::uint32_t* verdicts, const GpuWork& /*work*/) override
  {
    parts.push_back(states.count);
    for (std::size_t i = 0; i < states.count; ++i)
    {
      words[states.begin + i] = verdicts[i];
      ++brought[states.begin + i];
    }
  }

  std::vector<std::uint32_t> words;  // the verdicts
  std::vector<int> brought;          // how often, for each state
  std::vector<std::size_t> parts;    // the numbers of states

 private:
  std::size_t taken_ = 0;
};
}  // namespace gpu_planning_scene::core
