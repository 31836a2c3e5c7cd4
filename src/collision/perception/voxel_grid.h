#pragma once

#include <array>
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
  explicit VoxelGrid(double size) : size_(size), per_metre_(1.0 / size) {}

  double size() const { return size_; }
  /// The voxel that contains a point of the planning frame. Throws Error for a point that is too far from the origin.
  std::uint64_t keyOf(const Eigen::Vector3d& point) const;
  Eigen::Vector3d centreOf(std::uint64_t key) const;
  /// The keys of the voxel and of the 26 voxels that touch it.
  static std::array<std::uint64_t, 27> around(std::uint64_t key);
  /// The centres of the eight cubes of half the edge in each voxel with one of these centres.
  std::vector<Eigen::Vector3d> eighthsOf(const std::vector<Eigen::Vector3d>& centres) const;
  /// A cube around each centre, in the planning frame.
  std::vector<PlacedShape> cubesAt(const std::vector<Eigen::Vector3d>& centres) const;

 private:
  double size_;
  double per_metre_;
};

/// Collects keys, each once.
class VoxelKeys
{
 public:
  void add(std::uint64_t key)
  {
    std::uint64_t& last = lately_[(key * kHashFactor) >> (64 - kHashBits)];
    if (last != key)
      keys_.push_back(last = key);
  }
  /// The keys in ascending order.
  std::vector<std::uint64_t> take();

 private:
  static constexpr int kHashBits = 14;
  static constexpr std::uint64_t kHashFactor = 0x9E3779B97F4A7C15;  // 2^64 divided by the golden ratio (Knuth)
  static constexpr std::uint64_t kNoKey = ~std::uint64_t{0};

  // Many points are in the same voxels. Most of these are left out here, before the keys are sorted.
  std::vector<std::uint64_t> lately_ = std::vector<std::uint64_t>(std::size_t{1} << kHashBits, kNoKey);
  std::vector<std::uint64_t> keys_;
};
}  // namespace gpu_planning_scene::core
