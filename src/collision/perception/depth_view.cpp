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

std::size_t pixelOf(int x, int y, int width)
{
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

struct PixelInterval
{
  double first;
  double last;
};

/// The pixels in which the interval [centre - extent, centre + extent] at the depths [near, far] may appear, and one
/// more on each side. They may be outside the image.
PixelInterval intervalOf(double centre, double extent, double near, double far, double focal_length,
                         double principal_point)
{
  const double low = centre - extent;
  const double high = centre + extent;
  return {std::floor(principal_point + focal_length * std::min(low / near, low / far)) - 1.0,
          std::ceil(principal_point + focal_length * std::max(high / near, high / far)) + 1.0};
}

}  // namespace

DepthView::DepthView(const PinholeCamera& camera, std::vector<float> depths, bool has_gaps)
  : camera_(camera), has_gaps_(has_gaps)
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
        float& smallest = coarse.depths[pixelOf(x / 2, y / 2, coarse.width)];
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

bool DepthView::showsAll(const VoxelInView& voxel) const
{
  const auto& [centre, extent, inner_radius] = voxel;
  const double near = centre.z() - extent.z();
  const double far = centre.z() + extent.z();
  if (near <= 0.0)
    return false;
  const PixelInterval columns = intervalOf(centre.x(), extent.x(), near, far, camera_.fx, camera_.cx);
  const PixelInterval rows = intervalOf(centre.y(), extent.y(), near, far, camera_.fy, camera_.cy);
  return columns.first >= 0.0 && columns.last <= camera_.width - 1.0 && rows.first >= 0.0 &&
         rows.last <= camera_.height - 1.0;
}

DepthView::PixelRange DepthView::within(double first, double last, int size)
{
  const double border = size - 1;
  return {static_cast<int>(std::clamp(first, 0.0, border)), static_cast<int>(std::clamp(last, 0.0, border))};
}

bool DepthView::seesBehind(const VoxelInView& voxel) const
{
  const auto& [centre, extent, inner_radius] = voxel;
  const double near = centre.z() - extent.z();
  const double far = centre.z() + extent.z();
  if (near <= 0.0 || !shows(centre))
    return false;
  const PixelInterval u = intervalOf(centre.x(), extent.x(), near, far, camera_.fx, camera_.cx);
  const PixelInterval v = intervalOf(centre.y(), extent.y(), near, far, camera_.fy, camera_.cy);
  const PixelRange columns = within(u.first, u.last, camera_.width);
  const PixelRange rows = within(v.first, v.last, camera_.height);
  // A depth is less exact than a direction, so rays must end behind the ball around the voxel.
  const double behind = centre.z() + std::sqrt(3.0) * inner_radius;
  int level = 0;
  while ((std::max(columns.last - columns.first, rows.last - rows.first) >> level) >= kMaxReads)
    ++level;
  bool has_ray = false;  // in a square that overlaps the rectangle
  for (int y = rows.first >> level; y <= rows.last >> level; ++y)
    for (int x = columns.first >> level; x <= columns.last >> level; ++x)
    {
      if (!endBehind({level, x, y}, columns, rows, behind))
        return false;
      has_ray = has_ray || std::isfinite(smallestOf({level, x, y}));
    }
  return has_ray && (!has_gaps_ || passesThrough(centre, inner_radius));
}

float DepthView::smallestOf(const Square& square) const
{
  const Level& level = levels_[static_cast<std::size_t>(square.level)];
  return level.depths[pixelOf(square.x, square.y, level.width)];
}

/// Whether all pixels of the square that are in the rectangle are deeper than `far`. Looks at smaller squares only
/// where a pixel of the square is nearer: it may be outside the rectangle.
bool DepthView::endBehind(const Square& square, const PixelRange& columns, const PixelRange& rows, double far) const
{
  if (static_cast<double>(smallestOf(square)) > far)
    return true;
  if (square.level == 0)
    return false;
  const int level = square.level - 1;
  const auto part_of = [level](int half, const PixelRange& range) {
    return PixelRange{std::max(half, range.first >> level), std::min(half + 1, range.last >> level)};
  };
  const PixelRange x = part_of(2 * square.x, columns);
  const PixelRange y = part_of(2 * square.y, rows);
  for (int row = y.first; row <= y.last; ++row)
    for (int column = x.first; column <= x.last; ++column)
      if (!endBehind({level, column, row}, columns, rows, far))
        return false;
  return true;
}

/// Whether a ray is certain to pass through a ball. A ray is somewhere in its pixel, and the pixels of the square
/// inside the ball's image are within the ball.
bool DepthView::passesThrough(const Eigen::Vector3d& centre, double radius) const
{
  const auto pixels_of = [&](double coordinate, double focal_length, double principal_point, int size)
  {
    const double middle = principal_point + focal_length * coordinate / centre.z();
    const double half = focal_length * radius / (std::sqrt(2.0) * centre.z()) - 0.5;
    return PixelRange{static_cast<int>(std::clamp(std::ceil(middle - half), 0.0, 1.0 * size)),
                      static_cast<int>(std::clamp(std::floor(middle + half), -1.0, size - 1.0))};
  };
  const PixelRange columns = pixels_of(centre.x(), camera_.fx, camera_.cx, camera_.width);
  const PixelRange rows = pixels_of(centre.y(), camera_.fy, camera_.cy, camera_.height);
  for (int y = rows.first; y <= rows.last; ++y)
    for (int x = columns.first; x <= columns.last; ++x)
      if (std::isfinite(levels_[0].depths[camera_.pixel(x, y)]))
        return true;
  return false;
}
}  // namespace gpu_planning_scene::core
