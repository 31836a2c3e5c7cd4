#include "literature/image_space/view.h"

#include <algorithm>

namespace gpu_planning_scene::core::literature
{
namespace
{
/// The least half width of a picture as a share of `whole`, for boxes that only touch.
constexpr double kLeastWidth = 1e-7;
/// Keeps all depths away from the depth of an empty pixel, in spite of rounding.
constexpr double kDepthMargin = 1.001;
}  // namespace

std::optional<ViewVolume> viewVolume(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b)
{
  if (!a.intersects(b))
    return {};
  return ViewVolume{a.intersection(b), a.merged(b)};
}

std::vector<int> viewAxes(const ViewVolume& volume, int views)
{
  std::vector<int> axes = {0, 1, 2};
  if (views < 3)
    std::stable_sort(axes.begin(), axes.end(),
                     [&](int i, int k) { return volume.common.sizes()[i] < volume.common.sizes()[k]; });
  axes.resize(static_cast<std::size_t>(views));
  return axes;
}

Projection projectionAlong(int axis, const ViewVolume& volume, int resolution)
{
  const double border = 1.0 - 1.0 / resolution;
  const double least = kLeastWidth * volume.whole.diagonal().norm();
  Projection projection = Projection::Zero();
  for (int row = 0; row < 2; ++row)
  {
    const int from = (axis + 1 + row) % 3;
    const double scale = border / std::max(least, 0.5 * volume.common.sizes()[from]);
    projection(row, from) = scale;
    projection(row, 3) = -scale * volume.common.center()[from];
  }
  const double scale = -1.0 / (kDepthMargin * std::max(least, 0.5 * volume.whole.sizes()[axis]));
  projection(2, axis) = scale;
  projection(2, 3) = -scale * volume.whole.center()[axis];
  return projection;
}
}  // namespace gpu_planning_scene::core::literature
