#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "collision/gpu/tree_build/gpu_forest.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
/// A node with its oriented box in the layout of the GPU memory (shaders/traversal/bounding_volume_overlap.glsl). In
/// the frame of the mesh, in metres.
struct OrientedNode
{
  std::array<float, 3> center;
  std::uint32_t first;  ///< as in Node
  std::array<float, 3> half;
  std::uint32_t count;               ///< as in Node
  std::array<float, 4> orientation;  ///< quaternion x, y, z, w of the box in the mesh's frame
};
static_assert(sizeof(OrientedNode) == ORIENTED_NODE_TEXELS * TexelBuffer::kTexelBytes, "the layout of the shaders");

/// Fits an oriented box to the triangles of each node on the GPU, see shaders/tree_build/fit.glsl (Gottschalk, Lin and
/// Manocha, "OBBTree", 1996). Used on the context's thread.
class GpuOrientedBoxes
{
 public:
  explicit GpuOrientedBoxes(const std::string& shader_folder);

  /// Writes the oriented nodes of a region at the same indices as its nodes. Grows the buffer as needed.
  void fit(const ForestRegion& region, const TexelBuffer& nodes, const TexelBuffer& triangles, TexelBuffer& oriented);

 private:
  Program fit_program_, fit_large_program_;
  Buffer large_nodes_, large_count_;
};
}  // namespace gpu_planning_scene::core
