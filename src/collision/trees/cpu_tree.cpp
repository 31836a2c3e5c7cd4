#include "collision/trees/cpu_tree.h"

#include <iterator>
#include <mutex>
#include <unordered_map>

#include "collision/geometry/primitive_solid.h"
#include "collision/problem/shape_key.h"
#include "collision/trees/binned_sah.h"

// Converts trees with axis-aligned boxes into trees with oriented boxes. Oriented boxes fit triangles more closely, so
// a traversal visits fewer nodes (Gottschalk, Lin and Manocha, "OBBTree", 1996).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Matrix3d;

/// Copies a tree from a forest in depth-first order: nodes that are visited together lie together, and the triangles
/// below a node are contiguous. Does not set the boxes of the nodes.
void copyTree(const Forest& forest, std::size_t number, const Mesh& mesh, CpuTree& tree)
{
  tree.triangles.reserve(mesh.triangles.size());
  tree.roles.reserve(tree.mesh ? mesh.triangles.size() : 0);
  const auto add = [&](std::uint32_t from)
  {
    CpuNode& node = tree.nodes.emplace_back();
    node.first = forest.nodes[from].first;
    node.count = forest.nodes[from].count;
  };
  add(forest.roots[number]);
  std::vector<std::uint32_t> open = {0};
  while (!open.empty())
  {
    const std::uint32_t at = open.back();
    open.pop_back();
    const std::uint32_t first = tree.nodes[at].first;
    if (!tree.nodes[at].isLeaf())
    {
      const auto children = static_cast<std::uint32_t>(tree.nodes.size());
      tree.nodes[at].first = children;
      add(first);
      add(first + 1);
      open.insert(open.end(), {children + 1, children});
      continue;
    }
    tree.nodes[at].first = static_cast<std::uint32_t>(tree.triangles.size());
    for (std::uint32_t place = first; place < first + tree.nodes[at].count; ++place)
    {
      const std::uint32_t triangle = forest.leaf_triangles[place] - forest.first_triangle[number];
      const auto& corners = mesh.triangles[triangle];
      tree.triangles.push_back({mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]});
      if (tree.mesh)
        tree.roles.push_back(tree.solid->roles[triangle]);
    }
  }
}

/// Fits each node's box to the triangles below it.
void fitBoxes(CpuTree& tree)
{
  struct Below
  {
    TriangleSpread spread;
    std::uint32_t first;
    std::uint32_t count;
  };
  std::vector<Below> below(tree.nodes.size());
  for (std::size_t i = tree.nodes.size(); i-- > 0;)
  {
    CpuNode& node = tree.nodes[i];
    Below& all = below[i];
    if (node.isLeaf())
    {
      all = {TriangleSpread(tree.triangles[node.first]), node.first, node.count};
      for (std::uint32_t k = node.first + 1; k < node.first + node.count; ++k)
        all.spread = TriangleSpread(all.spread, TriangleSpread(tree.triangles[k]));
    }
    else
    {
      const Below& left = below[node.first];
      const Below& right = below[node.first + 1];
      all = {TriangleSpread(left.spread, right.spread), left.first, left.count + right.count};
    }
    node.box = fitOrientedBox(all.spread, &tree.triangles[all.first], all.count);
  }
}

/// The trees of this process, by shape. A tree holds its mesh, so a key's mesh cannot be another mesh at the same
/// address while the tree is in use.
class TreeRegistry
{
 public:
  std::shared_ptr<const CpuTree> find(const Shape& shape)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = trees_.find(ShapeKey(shape));
    return found == trees_.end() ? nullptr : found->second.lock();
  }

  void add(const std::shared_ptr<const CpuTree>& tree)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (trees_.size() > 2 * size_when_cleared_ + kFewEntries)
    {
      for (auto entry = trees_.begin(); entry != trees_.end();)
        entry = entry->second.expired() ? trees_.erase(entry) : std::next(entry);
      size_when_cleared_ = trees_.size();
    }
    trees_[ShapeKey(tree->shape)] = tree;
  }

 private:
  static constexpr std::size_t kFewEntries = 1024;

  std::mutex mutex_;  // guards the members below; not held while a tree is built
  std::unordered_map<ShapeKey, std::weak_ptr<const CpuTree>, ShapeKeyHash> trees_;
  std::size_t size_when_cleared_ = 0;
};

TreeRegistry& treeRegistry()
{
  static TreeRegistry registry;
  return registry;
}
}  // namespace

const std::vector<Component>& componentsOf(const CpuTree& tree)
{
  static const std::vector<Component> none;
  return tree.solid ? tree.solid->components : none;
}

std::shared_ptr<const CpuTree> makeCpuTree(const Shape& shape, const Tessellation& tessellation, const Forest& forest,
                                           std::size_t number)
{
  auto tree = std::make_shared<CpuTree>();
  tree->shape = shape;
  tree->mesh = isMesh(shape);
  if (tree->mesh)
  {
    const Node& root = forest.nodes[forest.roots[number]];
    tree->center = centerOf(root);
    tree->half = halfOf(root);
    tree->solid = tessellation.solid;
    for (const Component& component : tree->solid->components)
      if (component.solid)
        tree->solid_bounds.extend(component.bounds);
  }
  else
  {
    tree->center.setZero();
    tree->half = halfExtents(shape);
  }
  copyTree(forest, number, *tessellation.mesh, *tree);
  fitBoxes(*tree);
  tree->box = tree->mesh ? tree->nodes[0].box : OrientedBox{Matrix3d::Identity(), tree->center, tree->half};
  if (tree->mesh)
    tree->wide = WideTree(tree->nodes, tree->triangles, tree->center);
  return tree;
}

std::shared_ptr<const CpuTree> cpuTreeOf(const Shape& shape, const Tessellation& tessellation)
{
  if (std::shared_ptr<const CpuTree> tree = treeRegistry().find(shape))
    return tree;
  std::shared_ptr<const CpuTree> tree =
      makeCpuTree(shape, tessellation, buildBinnedSah(std::vector<Tessellation>{tessellation}), 0);
  treeRegistry().add(tree);
  return tree;
}

std::shared_ptr<const CpuTree> makeSolidTree(const Shape& solid)
{
  auto tree = std::make_shared<CpuTree>();
  tree->shape = solid;
  tree->mesh = false;
  tree->center.setZero();
  tree->half = halfExtents(solid);
  tree->box = {Matrix3d::Identity(), tree->center, tree->half};
  return tree;
}
}  // namespace gpu_planning_scene::core
