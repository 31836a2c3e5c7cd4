#include "collision/perception/voxel_grid.h"

#include <algorithm>
#include <string>
#include <utility>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr int kIndexBits = 21;
constexpr std::int64_t kMaxIndex = (std::int64_t{1} << (kIndexBits - 1)) - 1;
}  // namespace

std::uint64_t VoxelGrid::keyOf(const Vector3d& point) const
{
  const Vector3d place = per_metre_ * point;
  if (!(place.cwiseAbs().maxCoeff() <= static_cast<double>(kMaxIndex - 1)))
    throw Error("a measured point is more than " + std::to_string(kMaxIndex - 1) +
                " voxels from the planning frame's origin; use larger voxels or a nearer planning frame");
  std::uint64_t key = 0;
  for (const int axis : {2, 1, 0})  // with kMaxIndex added, the conversion to an integer rounds down
    key = key << kIndexBits | static_cast<std::uint64_t>(place[axis] + static_cast<double>(kMaxIndex));
  return key;
}

Vector3d VoxelGrid::centreOf(std::uint64_t key) const
{
  Vector3d centre;
  for (const int axis : {0, 1, 2})
  {
    const auto index =
        static_cast<std::int64_t>(key >> (axis * kIndexBits) & ((std::uint64_t{1} << kIndexBits) - 1)) - kMaxIndex;
    centre[axis] = (static_cast<double>(index) + 0.5) * size_;
  }
  return centre;
}

std::array<std::uint64_t, 27> VoxelGrid::around(std::uint64_t key)
{
  // keyOf() leaves room for one more voxel on each side, so no index overflows.
  std::array<std::uint64_t, 27> keys{};
  std::size_t next = 0;
  const std::uint64_t first = key - (1U | std::uint64_t{1} << kIndexBits | std::uint64_t{1} << (2 * kIndexBits));
  for (std::uint64_t x = 0; x < 3; ++x)
    for (std::uint64_t y = 0; y < 3; ++y)
      for (std::uint64_t z = 0; z < 3; ++z)
        keys[next++] = first + (x | y << kIndexBits | z << (2 * kIndexBits));
  return keys;
}

std::vector<Vector3d> VoxelGrid::eighthsOf(const std::vector<Vector3d>& centres) const
{
  const double quarter = 0.25 * size_;
  std::vector<Vector3d> eighths;
  eighths.reserve(8 * centres.size());
  for (const Vector3d& centre : centres)
    for (const double x : {-quarter, quarter})
      for (const double y : {-quarter, quarter})
        for (const double z : {-quarter, quarter})
          eighths.emplace_back(centre + Vector3d(x, y, z));
  return eighths;
}

std::vector<PlacedShape> VoxelGrid::cubesAt(const std::vector<Vector3d>& centres) const
{
  const Shape cube = Box{Vector3d::Constant(size_)};
  std::vector<PlacedShape> cubes;
  cubes.reserve(centres.size());
  for (const Vector3d& centre : centres)
    cubes.push_back({cube, Eigen::Isometry3d(Eigen::Translation3d(centre))});
  return cubes;
}

std::vector<std::uint64_t> VoxelKeys::take()
{
  std::sort(keys_.begin(), keys_.end());
  keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  return std::move(keys_);
}
}  // namespace gpu_planning_scene::core
