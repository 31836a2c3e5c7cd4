#include "collision/perception/depth_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gpu_planning_scene::core
{
namespace
{
constexpr int kMaxReads = 8;  // pixels of a level along each side of a rectangle

struct PixelRange
{
  int first;
  int last;
};

/// The pixels in which the interval [low, high] at the depths [near, far] may appear, and one more on each side.
PixelRange pixelsOf(double low, double high, double near, double far, double focal_length, double center, int size)
{
  const double first = center + focal_length * std::min(low / near, low / far);
  const double last = center + focal_length * std::max(high / near, high / far);
  const double border = size - 1;
  return {static_cast<int>(std::clamp(std::floor(first) - 1.0, 0.0, border)),
          static_cast<int>(std::clamp(std::ceil(last) + 1.0, 0.0, border))};
}
}  // namespace

DepthView::DepthView(const PinholeCamera& camera, std::vector<float> depths) : camera_(camera)
{
  levels_.push_back({camera.width, camera.height, std::move(depths)});
  while (levels_.back().width > 1 || levels_.back().height > 1)
  {
    const Level& fine = levels_.back();
    Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    coarse.depths.assign(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height),
                         std::numeric_limits<float>::infinity());
    const float* depth = fine.depths.data();
    for (int y = 0; y < fine.height; ++y)
      for (int x = 0; x < fine.width; ++x, ++depth)
      {
        float& smallest = coarse.depths[static_cast<std::size_t>((y / 2) * coarse.width + x / 2)];
        smallest = std::min(smallest, *depth);
      }
    levels_.push_back(std::move(coarse));
  }
}

bool DepthView::shows(const Eigen::Vector3d& point) const
{
  const double u = camera_.cx + camera_.fx * point.x() / point.z();
  const double v = camera_.cy + camera_.fy * point.y() / point.z();
  return point.z() > 0.0 && u >= -0.5 && u <= camera_.width - 0.5 && v >= -0.5 && v <= camera_.height - 0.5;
}

bool DepthView::seesBehind(const Eigen::Vector3d& center, double radius) const
{
  const double near = center.z() - radius;
  const double far = center.z() + radius;
  if (near <= 0.0 || !shows(center))
    return false;
  const PixelRange columns =
      pixelsOf(center.x() - radius, center.x() + radius, near, far, camera_.fx, camera_.cx, camera_.width);
  const PixelRange rows =
      pixelsOf(center.y() - radius, center.y() + radius, near, far, camera_.fy, camera_.cy, camera_.height);
  int level = 0;
  while ((std::max(columns.last - columns.first, rows.last - rows.first) >> level) >= kMaxReads)
    ++level;
  const Level& depths = levels_[static_cast<std::size_t>(level)];
  float smallest = std::numeric_limits<float>::infinity();
  for (int y = rows.first >> level; y <= rows.last >> level; ++y)
    for (int x = columns.first >> level; x <= columns.last >> level; ++x)
      smallest = std::min(smallest, depths.depths[static_cast<std::size_t>(y * depths.width + x)]);
  return std::isfinite(smallest) && static_cast<double>(smallest) > far;
}
}  // namespace gpu_planning_scene::core
