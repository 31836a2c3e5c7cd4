#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "collision/cpu/lanes/lane_model.h"

namespace gpu_planning_scene::core::lanes
{
/// Proves verdicts for `count` states (1 to kLanes rows of doubles). `margins`: the distances that pairs must keep in
/// addition, in metres, each in all lanes: of each instance from the world, then of each self pair; null: none. Every
/// verdict other than Proof::None is certain. One instruction set may prove a verdict that another one leaves open.
/// Thread-safe if each thread has its own scratch. Before a scratch is used with another model, its buffers must forget
/// the one before: see LaneBuffers::forget.
using Kernel = void (*)(const Model& model, const double* states, int count, const float* margins,
                        const Scratch& scratch, Block& block);

/// A margin as the kernel takes it: the rounding of its sums with other lengths is included.
inline float kernelMargin(double margin)
{
  return std::nextafter(static_cast<float>(margin * (1.0 + 0x1p-18)), std::numeric_limits<float>::max());
}

struct NamedKernel
{
  const char* instructions;
  Kernel kernel;
};

/// The kernels that this machine can run, the widest instruction set first. All instruction sets have one source,
/// lane_kernel_body.h.
const std::vector<NamedKernel>& availableKernels();
}  // namespace gpu_planning_scene::core::lanes
