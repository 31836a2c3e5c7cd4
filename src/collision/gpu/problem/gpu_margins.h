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
/// The margin, in metres, that the device gets for `margin`. It is never smaller: the smallest float that is not below
/// `margin` and that no device reads as 0. A negative margin becomes 0. A margin that is NaN or above the range of a
/// float becomes infinity; then no pair is proven free.
float uploadedMargin(double margin);

/// Margins of batches in GPU memory, see shaders/problem/margins.glsl. Used on the context's thread.
class GpuMargins
{
 public:
  void setPairs(const CollisionProblem& problem);

  /// The largest number of states whose margins fit into the device at once, if each state has its own row and the rows
  /// are in the order of the states.
  std::size_t maxStates() const;

  /// Uploads and binds the margins of the states [begin, begin + count).
  void write(const Margins& margins, std::size_t begin, std::size_t count);

 private:
  std::size_t robots_ = 0;
  std::vector<InstancePair> self_pairs_;
  std::vector<std::uint32_t> numbers_;  // [robot][robot]: margin number of each self pair; empty until first needed
  // Two buffers, so that margins are uploaded while the GPU works on the previous part.
  std::array<TexelBuffer, 2> uploads_;
  std::size_t next_upload_ = 0;
};
}  // namespace gpu_planning_scene::core
