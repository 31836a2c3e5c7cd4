#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/forest.h"
#include "gpu/buffer.h"
#include "gpu/program.h"

namespace gpu_planning_scene::core
{
/// Where a forest lies among others in shared buffers.
struct ForestRegion
{
  std::uint32_t first_node = 0;       ///< the roots lie here, one per mesh, then the pairs of children
  std::uint32_t node_count = 0;       ///< 2 * primitives - meshes
  std::uint32_t first_primitive = 0;  ///< of its primitives in the leaf order
  std::uint32_t primitive_count = 0;
  std::uint32_t depth = 0;  ///< no root lies further than this above a leaf
};

/// Builds bounding volume trees on the GPU, many at once: Morton order (Lauterbach et al. 2009), then bottom-up merging
/// of nearest neighbours by surface area (Meister and Bittner 2018, PLOC), which gives trees of SAH quality without a
/// separate pass of improvement, then leaves and nodes are laid out from the roots down.
/// Every primitive lies in exactly one leaf; zero-area and duplicate triangles are primitives like any other; the depth
/// is at most BUILD_ROUNDS. Used on the context's thread.
class GpuForestBuilder
{
 public:
  explicit GpuForestBuilder(const std::string& shader_folder);

  /// Trees over the triangles of `meshes`, with leaves of at most LEAF_TRIANGLES. Writes the nodes, the leaf order and
  /// the triangles' vertices (three texels each, in leaf order) after `region`'s first_node and first_primitive,
  /// growing the buffers as needed, and completes `region`. Throws Error where a mesh's coordinates do not fit into
  /// float32.
  void buildTriangles(const std::vector<const Mesh*>& meshes, ForestRegion& region, TexelBuffer& nodes,
                      Buffer& leaf_order, TexelBuffer& triangles);

 private:
  void build(std::size_t primitive_count, const std::vector<std::uint32_t>& first_primitive, std::uint32_t leaf_size,
             ForestRegion& region, TexelBuffer& nodes, Buffer& leaf_order);
  void sortByMorton(std::size_t primitive_count, std::size_t mesh_count);
  /// Returns the number of rounds that merged: a bound on the depth.
  std::uint32_t mergeClusters(std::size_t primitive_count, std::size_t mesh_count);
  void layOut(std::size_t mesh_count, std::uint32_t leaf_size, const ForestRegion& region, const TexelBuffer& nodes,
              const Buffer& leaf_order);

  Program boxes_program_, bounds_program_, morton_program_;
  Program sort_count_program_, sort_scan_program_, sort_scatter_program_;
  Program gather_program_, nearest_program_, count_program_, scan_program_, write_program_;
  Program layout_roots_program_, layout_pairs_program_, triangles_program_;

  Buffer vertices_, boxes_, mesh_of_, first_primitive_, bounds_, keys_[2], counts_, clusters_[2], cluster_info_[2];
  Buffer rounds_, nearest_, sums_, pairs_, pair_starts_;
};
}  // namespace gpu_planning_scene::core
