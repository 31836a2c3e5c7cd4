#include "literature/image_space/image_space_method.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr std::size_t kMostTriangles = 20000000;  // of all tiles together: a pass then takes less than a second

Eigen::AlignedBox3d boundsOf(const Mesh& mesh, const Eigen::Isometry3d& pose)
{
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    bounds.extend(pose * vertex);
  return bounds;
}

/// The projection of coordinates that are relative to `center`, in a mesh at `pose`.
std::array<float, 12> rowsOf(const Projection& projection, const Eigen::Isometry3d& pose, const Eigen::Vector3d& center)
{
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> rows;
  rows.leftCols<3>() = projection.leftCols<3>() * pose.linear();
  rows.col(3) = projection.leftCols<3>() * (pose * center) + projection.col(3);
  std::array<float, 12> values;
  std::transform(rows.data(), rows.data() + 12, values.begin(), [](double value) { return static_cast<float>(value); });
  return values;
}

/// See Tile::fattening. A fattened triangle covers the centre of each pixel in which the triangle has a point, although
/// the device rounds coordinates to float32, to a part of a pixel (kSnapping), and to the steps of the depth buffer.
std::array<float, 4> fatteningOf(const Projection& projection, const ViewVolume& volume, int resolution)
{
  constexpr double kSnapping = 0.05;
  constexpr double kRounding = 1e-6;
  const double size = volume.whole.diagonal().norm();
  const auto width = [&](int row) { return 2.0 / (resolution * projection.row(row).leftCols<3>().norm()); };
  const double mean_width = std::sqrt(width(0) * width(1));
  const auto half = [&](double pixel) { return static_cast<float>(kSnapping + kRounding * size / pixel); };
  return {0.5F + half(width(0)), 0.5F + half(width(1)), half(mean_width),
          static_cast<float>(1.0 / (projection.row(2).leftCols<3>().norm() * mean_width))};
}
}  // namespace

ImageSpaceMethod::ImageSpaceMethod(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b,
                                   ImageOptions options)
  : device_(RenderDevice::shared()),
    a_(device_->upload(a)),
    b_(device_->upload(b)),
    options_(std::move(options)),
    a_in_view_(options_.view_frame.inverse()),
    bounds_a_(boundsOf(*a, a_in_view_))
{
}

std::vector<std::uint8_t> ImageSpaceMethod::collide(const std::vector<Eigen::Isometry3d>& b_in_a)
{
  std::vector<std::uint8_t> answers(b_in_a.size(), 0);
  const std::size_t most =
      std::min(TileAtlas::capacity(options_.resolution),
               std::max<std::size_t>(3, kMostTriangles / (a_->triangleCount() + b_->triangleCount()))) /
      views();
  for (std::size_t begin = 0; begin < b_in_a.size();)
  {
    std::vector<PlacedPair> pairs;
    std::vector<std::size_t> places;
    for (; begin < b_in_a.size() && pairs.size() < most; ++begin)
      if (const auto volume = viewVolume(bounds_a_, boundsOf(*b_->mesh(), a_in_view_ * b_in_a[begin])))
      {
        pairs.push_back({b_in_a[begin], *volume, viewAxes(*volume, options_.views)});
        places.push_back(begin);
      }
    if (pairs.empty())
      continue;
    const std::vector<Tile> tiles = tilesOf(pairs);
    tiles_ += static_cast<double>(tiles.size());
    run(
        [&]
        {
          atlas().begin(options_.resolution, tiles, tiles.size());
          const std::vector<std::uint8_t> hits = draw(pairs);
          for (std::size_t i = 0; i < pairs.size(); ++i)
            answers[places[i]] = hits[i];
        });
  }
  return answers;
}

std::vector<Tile> ImageSpaceMethod::tilesOf(const std::vector<PlacedPair>& pairs) const
{
  std::vector<Tile> tiles;
  for (const PlacedPair& pair : pairs)
    for (const int axis : pair.axes)
    {
      const Projection projection = projectionAlong(axis, pair.volume, options_.resolution);
      tiles.push_back({rowsOf(projection, a_in_view_, a_->center()),
                       rowsOf(projection, a_in_view_ * pair.b_in_a, b_->center()),
                       fatteningOf(projection, pair.volume, options_.resolution)});
    }
  return tiles;
}

void ImageSpaceMethod::observe(const std::string& pass) const
{
  if (options_.observe)
    options_.observe(pass, atlas().read(0));
}

void ImageSpaceMethod::countPass(std::size_t primitives)
{
  passes_ += 1.0;
  primitives_ += static_cast<double>(primitives);
}

WorkCounts ImageSpaceMethod::work() const
{
  const double resolution = options_.resolution;
  return {{"views", tiles_},
          {"pixels of views", tiles_ * resolution * resolution},
          {"passes", passes_},
          {"drawn triangles and lines", primitives_}};
}

std::vector<std::uint8_t> anyView(const std::vector<std::uint32_t>& hits, std::size_t views)
{
  std::vector<std::uint8_t> any;
  for (auto first = hits.begin(); first != hits.end(); first += static_cast<std::ptrdiff_t>(views))
    any.push_back(
        std::any_of(first, first + static_cast<std::ptrdiff_t>(views), [](std::uint32_t hit) { return hit != 0; }) ? 1
                                                                                                                   : 0);
  return any;
}

std::vector<std::uint8_t> everyView(const std::vector<std::uint32_t>& hits, std::size_t views)
{
  std::vector<std::uint8_t> every;
  for (auto first = hits.begin(); first != hits.end(); first += static_cast<std::ptrdiff_t>(views))
    every.push_back(
        std::all_of(first, first + static_cast<std::ptrdiff_t>(views), [](std::uint32_t hit) { return hit != 0; }) ? 1
                                                                                                                   : 0);
  return every;
}
}  // namespace gpu_planning_scene::core::literature
