#include "collision/gpu/tree_build/gpu_oriented_boxes.h"

#include <algorithm>

#include "gpu/gl_check.h"
#include "shader_constants.h"

// One invocation fits the box of a small node. Nodes with many triangles are listed, and a work group fits each of
// them. Nodes of more than FIT_MAX_TRIANGLES triangles keep their axis-aligned box. The axes are chosen as in
// Gottschalk, Lin and Manocha, "OBBTree", 1996 (shaders/tree_build/fit.glsl).
namespace gpu_planning_scene::core
{
namespace
{
/// A dispatch over this many nodes takes less than 50 ms on llvmpipe. The second limit is for the large nodes that a
/// work group fits.
constexpr std::uint32_t kNodesAtOnce = 65536;
constexpr std::uint32_t kLargeNodesAtOnce = 64;
}  // namespace

GpuOrientedBoxes::GpuOrientedBoxes(const std::string& folder)
  : fit_program_(folder, "tree_build/fit_boxes.comp"), fit_large_program_(folder, "tree_build/fit_large_boxes.comp")
{
}

void GpuOrientedBoxes::fit(const ForestRegion& region, const TexelBuffer& nodes, const TexelBuffer& triangles,
                           TexelBuffer& oriented)
{
  oriented.reserve((std::size_t{region.first_node} + region.node_count) * sizeof(OrientedNode));
  large_nodes_.reserve(std::size_t{region.node_count} * LARGE_NODE_TEXELS * TexelBuffer::kTexelBytes);
  large_count_.reserve(sizeof(std::uint32_t));
  large_count_.clear();
  nodes.bindTexture(UNIT_NODES);
  triangles.bindTexture(UNIT_TRIANGLES);
  oriented.buffer().bindStorage(BINDING_ORIENTED_NODES);
  large_nodes_.bindStorage(BINDING_LARGE_NODES);
  large_count_.bindStorage(BINDING_LARGE_COUNT);
  for (std::uint32_t first = 0; first < region.node_count; first += kNodesAtOnce)
  {
    const std::uint32_t count = std::min(kNodesAtOnce, region.node_count - first);
    fit_program_.set(LOCATION_FIRST_NODE, region.first_node + first);
    fit_program_.set(LOCATION_NODE_COUNT, count);
    fit_program_.dispatch(groupsFor(count));
  }

  std::uint32_t large = 0;
  large_count_.read(&large, sizeof(large));
  for (std::uint32_t first = 0; first < large; first += kLargeNodesAtOnce)
  {
    const std::uint32_t count = std::min(kLargeNodesAtOnce, large - first);
    fit_large_program_.set(LOCATION_FIRST_LISTED, first);
    fit_large_program_.set(LOCATION_LISTED_COUNT, count);
    fit_large_program_.dispatch(count);
  }
  checkGl("fitting oriented boxes");
}
}  // namespace gpu_planning_scene::core
