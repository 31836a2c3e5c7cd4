#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/bounds/displacement_bounds.h"
#include "collision/problem/collision_problem.h"
#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// The margins of batches in GPU memory, see shaders/problem/margins.glsl. Used on the context's thread.
class GpuMargins
{
 public:
  void setPairs(const CollisionProblem& problem);

  /// How many states' margins a device holds at once, each with a row of its own, in the order of the states.
  std::size_t mostStates() const;

  /// Uploads those of states [begin, begin + count) and binds them.
  void write(const Margins& margins, std::size_t begin, std::size_t count);

 private:
  std::size_t robots_ = 0;
  std::vector<std::array<std::uint32_t, 2>> self_pairs_;
  std::vector<std::uint32_t> numbers_;  // [robot][robot]: of a self pair's margin; empty until they are needed
  // Two, so that those of the next part go up while the GPU works on those before.
  std::array<TexelBuffer, 2> uploads_;
  std::size_t next_upload_ = 0;
};
}  // namespace gpu_planning_scene::core
