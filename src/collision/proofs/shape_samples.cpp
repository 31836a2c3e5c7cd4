#include "collision/proofs/shape_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/math_constants.h"
#include "collision/exact/winding_number.h"
#include "collision/geometry/primitive_solid.h"
#include "collision/geometry/triangle_pair.h"

// A grid of cubes over the shape's box. triangleWithinSolid finds the cubes that the surface enters. The other cubes
// form connected parts; the winding number of one point tells whether a part is inside (Jacobson, Kavan and
// Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding Numbers", 2013). The solid angle of a
// triangle: A. van Oosterom, J. Strackee: The solid angle of a plane triangle. IEEE Transactions on Biomedical
// Engineering, 1983. The grid is our own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kCells = 32768.0;            // of the grid, about
constexpr std::size_t kMostPieces = 200'000;  // in addition to the triangles
constexpr std::size_t kFewInside = 100;
constexpr unsigned kTrianglesPerStopTest = 1000;
constexpr unsigned kPiecesPerStopTest = 100;
constexpr double kOnSurface = 1e-7;              // metres: exceeds the rounding error of distances
constexpr std::size_t kWindingTriangles = 4000;  // meshes without a solid: more triangles would take too long

/// Cuts a triangle by halving its longest edge until no edge is longer than `longest`. Gives up if there are more than
/// `most` pieces.
void cut(const Triangle& triangle, double longest, std::size_t most, std::vector<Triangle>& pieces)
{
  int edge = 0;
  std::array<double, 3> lengths;
  for (int i = 0; i < 3; ++i)
  {
    lengths[i] = (triangle[(i + 1) % 3] - triangle[i]).norm();
    edge = lengths[i] > lengths[edge] ? i : edge;
  }
  if (lengths[edge] <= longest || pieces.size() > most)
  {
    pieces.push_back(triangle);
    return;
  }
  const Vector3d middle = 0.5 * (triangle[edge] + triangle[(edge + 1) % 3]);
  cut({triangle[edge], middle, triangle[(edge + 2) % 3]}, longest, most, pieces);
  cut({middle, triangle[(edge + 1) % 3], triangle[(edge + 2) % 3]}, longest, most, pieces);
}

/// Pieces with edges of at most `longest`, or of a multiple of it if slivers would need too many pieces.
std::vector<Triangle> piecesOf(const std::vector<Triangle>& triangles, double longest, const Stopped& stopped)
{
  StopTest end_if_stopped(stopped, kTrianglesPerStopTest);
  const std::size_t most = triangles.size() + kMostPieces;
  std::vector<Triangle> pieces;
  for (;; longest *= 2.0)
  {
    pieces.clear();
    for (const Triangle& triangle : triangles)
    {
      end_if_stopped();
      cut(triangle, longest, most, pieces);
    }
    if (pieces.size() <= most)
      return pieces;
  }
}

CubeGrid gridAround(const AlignedBox3d& box)
{
  // A mesh may have no extent, or one of the size of rounding errors.
  const double least = 1e-9 * (1.0 + box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff());
  const double largest = std::max(box.sizes().maxCoeff(), least);
  const Vector3d sizes = box.sizes().cwiseMax(1e-2 * largest);
  CubeGrid grid;
  grid.cell = std::cbrt(sizes.prod() / kCells);
  grid.origin = box.center() - 0.5 * sizes;
  grid.count = (sizes / grid.cell).array().ceil().cast<int>();
  return grid;
}

/// The winding number of all triangles around a point. It is near 1 inside a mesh that is closed
/// except for cracks.
double windingNumber(const std::vector<Triangle>& triangles, const Vector3d& point)
{
  double sum = 0.0;
  for (const Triangle& t : triangles)
  {
    const Vector3d a = t[0] - point;
    const Vector3d b = t[1] - point;
    const Vector3d c = t[2] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * kPi);
}

/// For each cube: whether the surface enters it. Long pieces are cut again, because the box around a sliver may have
/// all cubes of the grid.
std::vector<bool> entered(const CubeGrid& grid, const std::vector<Triangle>& pieces, const Stopped& stopped)
{
  StopTest end_if_stopped(stopped, kPiecesPerStopTest);
  std::vector<bool> is_entered(static_cast<std::size_t>(grid.count.prod()), false);
  // Rounding must not hide a piece that touches a cube.
  const Shape cube = Box{Vector3d::Constant(grid.cell * (1.0 + 1e-9))};
  std::vector<Triangle> parts;
  for (const Triangle& piece : pieces)
  {
    parts.clear();
    cut(piece, grid.cell, kMostPieces, parts);
    for (const Triangle& part : parts)
    {
      end_if_stopped();
      AlignedBox3d box(part[0]);
      box.extend(part[1]).extend(part[2]);
      const Vector3d rounding = Vector3d::Constant(1e-6 * grid.cell);
      grid.each(grid.cubeOf(box.min() - rounding), grid.cubeOf(box.max() + rounding),
                [&](const Vector3i& at)
                {
                  const Vector3d center = grid.centerOf(at);
                  if (!is_entered[grid.numberOf(at)] &&
                      triangleWithinSolid({part[0] - center, part[1] - center, part[2] - center}, cube, 0.0))
                    is_entered[grid.numberOf(at)] = true;
                });
    }
  }
  return is_entered;
}

/// Connected parts of the cubes that no triangle enters. The points of a part are all inside a closed surface or all
/// outside, because the segment between the centres of two neighbours meets no triangle.
struct EmptyParts
{
  std::vector<int> part_of_cube;  // -1: the surface enters the cube
  std::vector<Vector3i> first;    // cube of each part
  std::vector<bool> at_border;    // of each part: it reaches the border of the grid

  EmptyParts(const CubeGrid& grid, const std::vector<bool>& is_entered) : part_of_cube(is_entered.size(), -1)
  {
    const Vector3i last = grid.count - Vector3i::Ones();
    std::vector<Vector3i> open;
    const auto visit = [&](const Vector3i& cube)
    {
      const std::size_t number = grid.numberOf(cube);
      if (is_entered[number] || part_of_cube[number] >= 0)
        return;
      part_of_cube[number] = static_cast<int>(first.size()) - 1;
      open.push_back(cube);
    };
    grid.each(Vector3i::Zero(), last,
              [&](const Vector3i& cube)
              {
                if (is_entered[grid.numberOf(cube)] || part_of_cube[grid.numberOf(cube)] >= 0)
                  return;
                first.push_back(cube);
                at_border.push_back(false);
                visit(cube);
                while (!open.empty())
                {
                  const Vector3i at = open.back();
                  open.pop_back();
                  for (int axis = 0; axis < 3; ++axis)
                    for (const int step : {-1, 1})
                    {
                      const Vector3i neighbour = at + step * Vector3i::Unit(axis);
                      if (neighbour[axis] < 0 || neighbour[axis] > last[axis])
                        at_border.back() = true;
                      else
                        visit(neighbour);
                    }
                }
              });
  }
};

/// Tells whether a cube is inside the shape, if the surface does not enter it.
class InsideCubes
{
 public:
  InsideCubes(const CpuTree& tree, const CubeGrid& grid, const std::vector<bool>& is_entered, const Stopped& stopped)
    : tree_(tree), grid_(grid), parts_(grid, is_entered)
  {
    const bool solid = hasSolid(tree);
    by_winding_ = !solid && tree.triangles.size() <= kWindingTriangles;
    has_hole_ =
        by_winding_ && std::all_of(parts_.at_border.begin(), parts_.at_border.end(), [](bool at) { return at; });
    std::vector<std::uint32_t> stack;
    StopTest end_if_stopped(stopped);
    for (const Vector3i& cube : parts_.first)
    {
      end_if_stopped();
      const Vector3d center = grid.centerOf(cube);
      // The triangles separate the parts. So the triangles of a primitive decide, and not its true surface.
      inside_.push_back(solid && tree.mesh
                            ? isInsideSolid(tree, center, stack)
                            : (by_winding_ || !tree.mesh) && windingNumber(tree.triangles, center) > 0.5);
    }
  }

  /// `cube`: the surface does not enter it.
  bool contains(const Vector3i& cube) const
  {
    // The inside of a mesh with a large hole is connected with its outside.
    return has_hole_ ? windingNumber(tree_.triangles, grid_.centerOf(cube)) > 0.5
                     : inside_[static_cast<std::size_t>(parts_.part_of_cube[grid_.numberOf(cube)])];
  }

 private:
  const CpuTree& tree_;
  const CubeGrid& grid_;
  EmptyParts parts_;
  bool by_winding_;
  bool has_hole_;
  std::vector<bool> inside_;  // of each part
};
}  // namespace

bool hasSolid(const CpuTree& tree)
{
  return !tree.mesh || !tree.solid_bounds.isEmpty();
}

bool insideSolid(const CpuTree& tree, const Vector3d& point)
{
  if (!tree.mesh)
    return distanceToSolid(tree.shape, point) == 0.0;
  std::vector<std::uint32_t> stack;
  // The winding number of a point on the surface is not defined.
  return tree.solid_bounds.contains(point) && distanceFromSurface(tree, point) > kOnSurface &&
         isInsideSolid(tree, point, stack);
}

/// Branch and bound over the tree's boxes, the nearer child first.
double distanceFromSurface(const CpuTree& tree, const Vector3d& point)
{
  const auto distance_to = [&](std::uint32_t node)
  {
    const OrientedBox& box = tree.nodes[node].box;
    const Vector3d beyond = (box.axes.transpose() * (point - box.center)).cwiseAbs() - box.half;
    return (1.0 - 1e-9) * beyond.cwiseMax(0.0).norm();
  };
  double best = std::numeric_limits<double>::max();
  std::vector<std::pair<double, std::uint32_t>> open{{0.0, 0}};
  while (!open.empty())
  {
    const auto [distance, number] = open.back();
    open.pop_back();
    if (distance >= best)
      continue;
    const CpuNode& node = tree.nodes[number];
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
      best = std::min(best, (nearestPoint(tree.triangles[t], point) - point).norm());
    if (node.isLeaf())
      continue;
    std::pair<double, std::uint32_t> far = {distance_to(node.first), node.first};
    std::pair<double, std::uint32_t> near = {distance_to(node.first + 1), node.first + 1};
    if (far < near)
      std::swap(far, near);
    open.push_back(far);
    open.push_back(near);
  }
  return best;
}

ShapeSamples samplesOf(const CpuTree& tree, const Stopped& stopped)
{
  StopTest end_if_stopped(stopped);
  AlignedBox3d box;
  for (const Triangle& triangle : tree.triangles)
    for (const Vector3d& vertex : triangle)
      box.extend(vertex);
  const CubeGrid grid = gridAround(box);
  ShapeSamples samples;
  samples.grid = grid;
  samples.pieces = piecesOf(tree.triangles, grid.cell, stopped);

  const std::vector<bool> is_entered = entered(grid, samples.pieces, stopped);
  std::vector<bool> has_point(is_entered.size(), false);
  for (const Triangle& piece : samples.pieces)
    for (const Vector3d& vertex : piece)
    {
      const std::size_t number = grid.numberOf(grid.cubeOf(vertex));
      if (!has_point[number])
        samples.points.push_back(vertex);
      has_point[number] = true;
    }

  const bool solid = hasSolid(tree);
  const auto add = [&](const Vector3i& cube)
  {
    const Vector3d center = grid.centerOf(cube);
    samples.inside.push_back({center, distanceFromSurface(tree, center)});
  };
  const Vector3i last = grid.count - Vector3i::Ones();
  const InsideCubes inside(tree, grid, is_entered, stopped);
  grid.each(Vector3i::Zero(), last,
            [&](const Vector3i& cube)
            {
              end_if_stopped();
              if (is_entered[grid.numberOf(cube)] || !(solid || cube.sum() % 4 == 0) || !inside.contains(cube))
                return;
              add(cube);
              if (solid)
                samples.cells.push_back(samples.inside.back());
            });
  // In thin shapes, the surface enters nearly all cubes.
  if (solid && samples.inside.size() < kFewInside)
    grid.each(Vector3i::Zero(), last,
              [&](const Vector3i& cube)
              {
                end_if_stopped();
                if (is_entered[grid.numberOf(cube)] && cube.sum() % 4 == 0 && insideSolid(tree, grid.centerOf(cube)))
                  add(cube);
              });
  return samples;
}
}  // namespace gpu_planning_scene::core
