#include "collision/gpu/tree_build/built_trees.h"

#include <cmath>
#include <limits>
#include <mutex>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "shader_constants.h"

// Visits each tree from its root, children from left to right. The triangles of a subtree are contiguous in leaf order,
// so the leaves must follow each other without gaps. Own method: a driver that mixes up the order of transfers builds
// trees that have the right number of nodes and other wrong contents.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kCornerFloats = 4;
constexpr std::size_t kTriangleFloats = 3 * kCornerFloats;
static_assert(kTriangleFloats == TRIANGLE_TEXELS * kCornerFloats, "a texel a corner");

/// A device may replace denormal numbers by 0.
bool isSame(float found, double expected)
{
  const auto rounded = static_cast<float>(expected);
  constexpr float kLeast = std::numeric_limits<float>::min();
  return found == rounded || (std::abs(found) < kLeast && std::abs(rounded) < kLeast);
}

/// The first fault in the tree of one mesh.
class TreeVisit
{
 public:
  TreeVisit(const BuiltTrees& trees, const Mesh& mesh, std::uint32_t first_triangle)
    : trees_(trees), mesh_(mesh), first_(first_triangle), next_(first_triangle)
  {
  }

  std::string fault(std::uint32_t root)
  {
    checkTriangles();
    if (fault_.empty())
      visit(root, 0);
    if (fault_.empty() && next_ - first_ != mesh_.triangles.size())
      fault_ = "the leaves of a tree end too early";
    return fault_;
  }

 private:
  /// Triangles in leaf order, without those before the region.
  std::size_t place(std::uint32_t triangle) const { return triangle - trees_.region.first_primitive; }

  void checkTriangles()
  {
    std::vector<char> seen(mesh_.triangles.size(), 0);
    for (std::uint32_t at = first_; at < first_ + seen.size(); ++at)
    {
      const std::uint32_t triangle = trees_.leaf_order[place(at)] - first_;
      if (triangle >= seen.size() || seen[triangle] != 0)
      {
        fault_ = "a triangle is in no leaf";
        return;
      }
      seen[triangle] = 1;
      for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (!isSame(trees_.corners[kTriangleFloats * place(at) + kCornerFloats * corner + axis],
                      mesh_.vertices[mesh_.triangles[triangle][corner]][static_cast<Eigen::Index>(axis)]))
          {
            fault_ = "a triangle has other corners than its mesh";
            return;
          }
    }
  }

  /// Returns the bounds of the triangles below the node. After a fault, they mean nothing.
  Eigen::AlignedBox3d visit(std::uint32_t index, std::uint32_t depth)
  {
    Eigen::AlignedBox3d bounds;
    const std::uint32_t at = index - trees_.region.first_node;
    if (at >= trees_.nodes.size())
    {
      fault_ = "a node is at no place of its tree";
      return bounds;
    }
    if (depth > trees_.region.depth)
    {
      fault_ = "a node is at level " + std::to_string(depth) + ", more than the " +
               std::to_string(trees_.region.depth) + " levels that were counted";
      return bounds;
    }
    const Node& node = trees_.nodes[at];
    const std::uint32_t begin = next_;
    if (node.count == 0)
    {
      for (const std::uint32_t child : {node.first, node.first + 1})
        if (fault_.empty())
          bounds.extend(visit(child, depth + 1));
    }
    else
      bounds = leafBounds(node);
    if (!fault_.empty())
      return bounds;
    if (!contains(node, bounds))
      fault_ = "a box does not contain the triangles below it";
    else
      checkOriented(node, trees_.oriented[at], begin, next_);
    return bounds;
  }

  static bool contains(const Node& node, const Eigen::AlignedBox3d& bounds)
  {
    // Written so that NaN is outside.
    return ((bounds.min() - centerOf(node)).array() >= -halfOf(node).array()).all() &&
           ((bounds.max() - centerOf(node)).array() <= halfOf(node).array()).all();
  }

  Eigen::AlignedBox3d leafBounds(const Node& leaf)
  {
    Eigen::AlignedBox3d bounds;
    if (leaf.first != next_ || leaf.count > kLeafTriangles || next_ - first_ + leaf.count > mesh_.triangles.size())
    {
      fault_ = "a leaf has the triangles of another one";
      return bounds;
    }
    for (; next_ < leaf.first + leaf.count; ++next_)
      for (const std::uint32_t corner : mesh_.triangles[trees_.leaf_order[place(next_)] - first_])
        bounds.extend(mesh_.vertices[corner]);
    return bounds;
  }

  void checkOriented(const Node& node, const OrientedNode& box, std::uint32_t begin, std::uint32_t end)
  {
    constexpr std::uint32_t kTested = 4;
    const Eigen::Vector3d center(box.center[0], box.center[1], box.center[2]);
    const Eigen::Vector3d half(box.half[0], box.half[1], box.half[2]);
    const auto& q = box.orientation;
    const Eigen::Matrix3d into = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix().transpose();
    bool is_right = node.first == box.first && node.count == box.count;
    const std::uint32_t stride = (end - begin + kTested - 1) / kTested;
    for (std::uint32_t triangle = begin; triangle < end; triangle += stride)
      for (std::size_t corner = 0; corner < 3; ++corner)
      {
        const float* const v = &trees_.corners[kTriangleFloats * place(triangle) + kCornerFloats * corner];
        is_right =
            is_right && ((into * (Eigen::Vector3d(v[0], v[1], v[2]) - center)).array().abs() <= half.array()).all();
      }
    if (!is_right)
      fault_ = "an oriented box does not fit its node";
  }

  const BuiltTrees& trees_;
  const Mesh& mesh_;
  const std::uint32_t first_;  // the number of the mesh's first triangle
  std::uint32_t next_;         // the first triangle in leaf order that no visited leaf has
  std::string fault_;
};
}  // namespace

std::string faultOf(const BuiltTrees& trees, const std::vector<const Mesh*>& meshes)
{
  std::vector<std::uint32_t> first;
  std::uint32_t next = trees.region.first_primitive;
  for (const Mesh* mesh : meshes)
  {
    first.push_back(next);
    next += static_cast<std::uint32_t>(mesh->triangles.size());
  }
  std::mutex mutex;
  std::string found;
  parallelFor(meshes.size(), 1,
              [&](std::size_t begin, std::size_t end)
              {
                for (std::size_t i = begin; i < end; ++i)
                {
                  const auto root = trees.region.first_node + static_cast<std::uint32_t>(i);
                  const std::string fault = TreeVisit(trees, *meshes[i], first[i]).fault(root);
                  const std::lock_guard<std::mutex> lock(mutex);
                  if (found.empty() && !fault.empty())
                    found = "mesh " + meshes[i]->name + ": " + fault;
                }
              });
  return found;
}
}  // namespace gpu_planning_scene::core
