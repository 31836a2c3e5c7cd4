#include "scene/changes/octree_cubes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"

// Finds the octree that has given cubes as its leaves. The cubes are sorted along the Morton curve (G. M. Morton: A
// computer oriented geodetic data base and a new technique in file sequencing. IBM, 1966), so the leaves below a node
// are neighbours.
namespace gpu_planning_scene::core
{
namespace
{
constexpr unsigned kLevels = 16;
constexpr double kGridWidth = 1U << kLevels;  // in smallest leaves
constexpr double kGridTolerance = 1e-6;       // in smallest leaves: exceeds the rounding of positions

struct GridLeaf
{
  std::uint64_t code;  // Morton code of its lowest corner, with 16 bits per axis
  unsigned height;     // its edge length is 2^height smallest leaves

  std::uint64_t end() const { return code + (std::uint64_t{1} << (3U * height)); }
};
using Leaves = std::vector<GridLeaf>;

[[noreturn]] void failNoLeaf(std::size_t cube)
{
  throw Error("octomap: shape " + std::to_string(cube) + " is not a leaf of an octree, whose leaves are cubes");
}

double edgeOf(const PlacedShape& placed, std::size_t cube)
{
  const Box* const box = std::get_if<Box>(&placed.shape);
  if (box == nullptr || box->size.x() != box->size.y() || box->size.x() != box->size.z() || !(box->size.x() > 0.0) ||
      placed.pose.linear() != Eigen::Matrix3d::Identity())
    failNoLeaf(cube);
  return box->size.x();
}

/// Spreads 16 bits, so that two zeros follow each of them.
std::uint64_t spread(std::uint64_t bits)
{
  bits = (bits | bits << 16U) & 0x0000'0000'FF00'00FFU;
  bits = (bits | bits << 8U) & 0x0000'00F0'0F00'F00FU;
  bits = (bits | bits << 4U) & 0x0000'0C30'C30C'30C3U;
  return (bits | bits << 2U) & 0x0000'2492'4924'9249U;
}

GridLeaf leafOf(const PlacedShape& placed, std::size_t cube, double resolution)
{
  const double width = edgeOf(placed, cube) / resolution;
  const int height = std::ilogb(width);
  if (width > kGridWidth || std::ldexp(1.0, height) != width)
    failNoLeaf(cube);
  GridLeaf leaf{0, static_cast<unsigned>(height)};
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = placed.pose.translation()[axis] / resolution - 0.5 * width + 0.5 * kGridWidth;
    const double whole = std::round(low / width) * width;
    if (!(std::abs(low - whole) <= kGridTolerance) || whole < 0.0 || whole + width > kGridWidth)
      failNoLeaf(cube);
    leaf.code |= spread(static_cast<std::uint64_t>(whole)) << static_cast<unsigned>(axis);
  }
  return leaf;
}

double smallestEdge(const std::vector<PlacedShape>& cubes)
{
  double smallest = kLargestLength;
  for (std::size_t i = 0; i < cubes.size(); ++i)
    smallest = std::min(smallest, edgeOf(cubes[i], i));
  return smallest;
}

/// Whether a cube around the origin is the whole octree. It is not in the grid of its own size.
bool isRootAlone(const std::vector<PlacedShape>& cubes)
{
  return cubes.size() == 1 && cubes.front().pose.translation() == Eigen::Vector3d::Zero();
}

Leaves sortedLeaves(const std::vector<PlacedShape>& cubes, double resolution)
{
  Leaves leaves;
  leaves.reserve(cubes.size());
  for (std::size_t i = 0; i < cubes.size(); ++i)
    leaves.push_back(leafOf(cubes[i], i, resolution));
  const auto is_before = [](const GridLeaf& a, const GridLeaf& b) { return a.code < b.code; };
  if (!std::is_sorted(leaves.begin(), leaves.end(), is_before))
    std::sort(leaves.begin(), leaves.end(), is_before);
  for (std::size_t i = 1; i < leaves.size(); ++i)
    if (leaves[i - 1].end() > leaves[i].code)
      throw Error("octomap: two cubes overlap, so they are not the leaves of an octree");
  return leaves;
}

/// Writes the leaves from `begin` to `end` below a node of this height: two bits per child, then its inner children.
void writeNode(const GridLeaf* begin, const GridLeaf* end, std::uint64_t code, unsigned height,
               std::vector<std::int8_t>& bytes)
{
  const std::size_t place = bytes.size();
  bytes.resize(place + 2);
  unsigned kinds = 0;
  for (unsigned child = 0; child < 8; ++child)
  {
    const GridLeaf node{code + (std::uint64_t{child} << (3U * (height - 1))), height - 1};
    const GridLeaf* const next =
        std::lower_bound(begin, end, node.end(), [](const GridLeaf& leaf, std::uint64_t at) { return leaf.code < at; });
    if (begin != next)
    {
      const bool is_leaf = begin->height == node.height;
      kinds |= (is_leaf ? 2U : 3U) << (2U * child);
      if (!is_leaf)
        writeNode(begin, next, node.code, node.height, bytes);
    }
    begin = next;
  }
  bytes[place] = static_cast<std::int8_t>(kinds & 0xFFU);
  bytes[place + 1] = static_cast<std::int8_t>(kinds >> 8U);
}
}  // namespace

void requireOctree(const std::vector<PlacedShape>& cubes)
{
  const double resolution = smallestEdge(cubes);
  if (!isRootAlone(cubes))
    sortedLeaves(cubes, resolution);
}

SerializedOctree octreeOf(const std::vector<PlacedShape>& cubes)
{
  SerializedOctree octree;
  octree.resolution = smallestEdge(cubes);
  if (isRootAlone(cubes))
  {
    octree.resolution /= kGridWidth;
    octree.bytes = {0, 0};
    return octree;
  }
  const Leaves leaves = sortedLeaves(cubes, octree.resolution);
  if (!leaves.empty())
    writeNode(leaves.data(), leaves.data() + leaves.size(), 0, kLevels, octree.bytes);
  return octree;
}
}  // namespace gpu_planning_scene::core
