#include "gpu_planning_scene/octomap.h"

#include <cmath>
#include <cstring>

#include "gpu_planning_scene/error.h"

// Reads the formats of liboctomap (A. Hornung, K. M. Wurm, M. Bennewitz, C. Stachniss, W. Burgard: OctoMap. Autonomous
// Robots, 2013). liboctomap's own reader follows wrong data without a bound on depth, so it may exhaust the stack.
namespace gpu_planning_scene::core
{
namespace
{
constexpr int kTreeDepth = 16;
constexpr double kTreeWidth = 1 << kTreeDepth;  // in smallest leaves

/// A cube of the grid: the indices of its lowest corner, and its edge length in smallest leaves.
struct Cell
{
  Eigen::Vector3d low;
  double width;

  Cell child(unsigned index) const
  {
    const double half = 0.5 * width;
    return {low + half * Eigen::Vector3d(index & 1U, (index >> 1U) & 1U, (index >> 2U) & 1U), half};
  }
};

class LeafReader
{
 public:
  LeafReader(const SerializedOctree& octree, std::size_t max_leaves) : octree_(octree), max_leaves_(max_leaves) {}

  std::vector<PlacedShape> read()
  {
    const Cell root{Eigen::Vector3d::Constant(-0.5 * kTreeWidth), kTreeWidth};
    if (octree_.binary)
      readBinaryRoot(root);
    else
      readFull(root, 0);
    if (place_ != octree_.bytes.size())
      throw Error("octomap: " + std::to_string(octree_.bytes.size() - place_) +
                  " bytes follow the end of the octree; check the fields 'binary' and 'id'");
    return std::move(cubes_);
  }

 private:
  /// The children of a node. Each has two bits: 0 unknown, 1 a free leaf, 2 an occupied leaf, 3 an inner node.
  unsigned childrenOfBinary()
  {
    const unsigned low = byte();
    return low | unsigned{byte()} << 8U;
  }

  /// An octree that is pruned to its root has a root without children. liboctomap reads it as occupied.
  void readBinaryRoot(const Cell& root)
  {
    const unsigned children = childrenOfBinary();
    if (children == 0)
      addLeaf(root);
    readBinaryChildren(children, root, 0);
  }

  /// The data of the inner nodes follow in the order of the children.
  void readBinaryChildren(unsigned children, const Cell& cell, int depth)
  {
    requireDepth(depth + 1);
    for (unsigned child = 0; child < 8; ++child)
    {
      const unsigned kind = children >> (2U * child) & 3U;
      if (kind == 2U)
        addLeaf(cell.child(child));
      else if (kind == 3U)
        readBinaryChildren(childrenOfBinary(), cell.child(child), depth + 1);
    }
  }

  /// A node: its occupancy as the logarithm of the odds, in a ColorOcTree its colour, and a bit for each child.
  void readFull(const Cell& cell, int depth)
  {
    requireDepth(depth);
    const float log_odds = number();
    if (octree_.id == "ColorOcTree")
      for (int i = 0; i < 3; ++i)
        byte();
    const unsigned children = byte();
    if (children == 0)
    {
      if (std::isnan(log_odds))
        throw Error("octomap: the occupancy of a leaf is not a number");
      if (log_odds >= 0.0F)
        addLeaf(cell);
    }
    for (unsigned child = 0; child < 8; ++child)
      if ((children >> child & 1U) != 0)
        readFull(cell.child(child), depth + 1);
  }

  static void requireDepth(int depth)
  {
    if (depth > kTreeDepth)
      throw Error("octomap: the octree has more than " + std::to_string(kTreeDepth) + " levels");
  }

  void addLeaf(const Cell& cell)
  {
    if (cubes_.size() >= max_leaves_)
      throw Error("octomap: it has more than " + std::to_string(max_leaves_) +
                  " occupied leaves (limits/voxels); use a coarser resolution, or prune it");
    const Eigen::Vector3d center = (cell.low.array() + 0.5 * cell.width).matrix() * octree_.resolution;
    cubes_.push_back({Box{Eigen::Vector3d::Constant(cell.width * octree_.resolution)},
                      Eigen::Isometry3d(Eigen::Translation3d(center))});
  }

  std::uint8_t byte()
  {
    if (place_ == octree_.bytes.size())
      throw Error("octomap: the data end inside of the octree, after " + std::to_string(place_) + " bytes");
    return static_cast<std::uint8_t>(octree_.bytes[place_++]);
  }

  float number()
  {
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < 4; ++i)
      bits |= std::uint32_t{byte()} << (8U * i);
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }

  const SerializedOctree& octree_;
  const std::size_t max_leaves_;
  std::size_t place_ = 0;
  std::vector<PlacedShape> cubes_;
};
}  // namespace

std::vector<PlacedShape> occupiedLeaves(const SerializedOctree& octree, std::size_t max_leaves)
{
  if (octree.bytes.empty())
    return {};
  if (octree.id != "OcTree" && octree.id != "ColorOcTree")
    throw Error("octomap: its octree is a '" + octree.id.substr(0, 40) + "'; known are OcTree and ColorOcTree");
  if (!(octree.resolution > 0.0) || octree.resolution > kLargestLength)
    throw Error("octomap: the resolution is " + std::to_string(octree.resolution) +
                "; it must be a length above 0, up to 1000 km");
  return LeafReader(octree, max_leaves).read();
}
}  // namespace gpu_planning_scene::core
