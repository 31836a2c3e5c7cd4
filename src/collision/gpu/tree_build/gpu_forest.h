#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/trees/forest.h"
#include "gpu/buffer.h"
#include "gpu/program.h"

namespace gpu_planning_scene::core
{
/// The place of a forest in buffers that it shares with other forests.
struct ForestRegion
{
  std::uint32_t first_node = 0;       ///< first the roots, one per mesh, then the pairs of children
  std::uint32_t node_count = 0;       ///< 2 * primitives - meshes
  std::uint32_t first_primitive = 0;  ///< first primitive in the leaf order
  std::uint32_t primitive_count = 0;
  std::uint32_t depth = 0;  ///< upper bound of the number of levels between a root and a leaf
};

/// Builds bounding volume hierarchies on the GPU, many at once. Primitives are sorted in Morton order (Lauterbach et
/// al., "Fast BVH Construction on GPUs", 2009). Nearest neighbours by surface area are then merged from the leaves up
/// (Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction", 2018). This
/// gives trees of SAH quality without a separate optimisation pass. Finally leaves and nodes are laid out from the
/// roots down.
///
/// Each primitive is in exactly one leaf, also zero-area and duplicate triangles. The depth is at most BUILD_ROUNDS.
/// Used on the context's thread.
class GpuForestBuilder
{
 public:
  explicit GpuForestBuilder(const std::string& shader_folder);

  /// Builds trees over the triangles of `meshes`, with leaves of at most LEAF_TRIANGLES. Writes the nodes, the leaf
  /// order and the triangles' vertices (three texels each, in leaf order), beginning at first_node and first_primitive
  /// of `region`. Grows the buffers as needed and fills in the rest of `region`. Throws Error if a mesh's coordinates
  /// are too large for float32.
  void buildTriangles(const std::vector<const Mesh*>& meshes, ForestRegion& region, TexelBuffer& nodes,
                      Buffer& leaf_order, TexelBuffer& triangles);

 private:
  void build(std::size_t primitive_count, const std::vector<std::uint32_t>& first_primitive, std::uint32_t leaf_size,
             ForestRegion& region, TexelBuffer& nodes, Buffer& leaf_order);
  void sortByMorton(std::size_t primitive_count, std::size_t mesh_count);
  /// Returns the number of rounds that merged clusters, which is an upper bound of the depth.
  std::uint32_t mergeClusters(std::size_t primitive_count, std::size_t mesh_count);
  void layOut(std::size_t mesh_count, std::uint32_t leaf_size, const ForestRegion& region, const TexelBuffer& nodes,
              const Buffer& leaf_order);

  Program boxes_program_, bounds_program_, morton_program_;
  Program sort_count_program_, sort_scan_program_, sort_scatter_program_;
  Program gather_program_, nearest_program_, count_program_, scan_program_, write_program_;
  Program layout_roots_program_, layout_pairs_program_, triangles_program_;

  Buffer vertices_, boxes_, mesh_of_, first_primitive_, bounds_, keys_[2], counts_, cluster_info_[2];
  TexelBuffer clusters_[2];
  Buffer rounds_, nearest_, sums_, pairs_, pair_starts_;
};
}  // namespace gpu_planning_scene::core
