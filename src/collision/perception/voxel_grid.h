#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The voxels around the planning frame's origin, which is a corner of eight of them. A key names a voxel; it has 63
/// bits, 21 for each index. The grid is that of PCL's VoxelGrid filter (R. B. Rusu, S. Cousins: 3D is here: Point Cloud
/// Library. ICRA 2011).
class VoxelGrid
{
 public:
  /// `size`: metres, above 0: edge length of a voxel.
  explicit VoxelGrid(double size) : size_(size) {}

  double size() const { return size_; }
  /// The voxel that contains a point of the planning frame. Throws Error for a point that is too far from the origin.
  std::uint64_t keyOf(const Eigen::Vector3d& point) const;
  Eigen::Vector3d centerOf(std::uint64_t key) const;
  /// A cube around each center, in the planning frame.
  std::vector<PlacedShape> cubesAt(const std::vector<Eigen::Vector3d>& centers) const;

 private:
  double size_;
};

/// Sorts the keys, and removes all but one of equal keys.
void sortOnce(std::vector<std::uint64_t>& keys);
}  // namespace gpu_planning_scene::core
