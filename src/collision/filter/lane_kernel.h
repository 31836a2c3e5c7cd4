#pragma once

#include <vector>

#include "collision/filter/lane_model.h"

namespace gpu_planning_scene::core::lanes
{
/// Proves verdicts for `count` states (1 to kLanes rows of doubles). Every verdict other than Proof::None holds.
/// Another instruction set may prove a verdict where this one proves none. Thread-safe if each thread has its own
/// scratch.
using Kernel = void (*)(const Model& model, const double* states, int count, const Scratch& scratch, Block& block);

struct NamedKernel
{
  const char* instructions;
  Kernel kernel;
};

/// The kernels that this machine can run, the widest instruction set first. All instruction sets have one source,
/// lane_kernel_body.h.
const std::vector<NamedKernel>& availableKernels();
}  // namespace gpu_planning_scene::core::lanes
