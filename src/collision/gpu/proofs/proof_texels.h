#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/cpu/lanes/lane_scene.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
using ProofTexel = std::array<std::uint32_t, TEXEL_WORDS>;

/// The scene of the lane kernel in the layout of shaders/proofs/records.glsl.
std::vector<ProofTexel> proofTexels(const LaneScene& scene);

/// The number of texels of a table's cells. The cells of the first table begin at RECORDS_HEADER, those of the others
/// follow.
std::uint32_t texelsOfCells(const lanes::Table& table);
}  // namespace gpu_planning_scene::core
