#include "collision/exact/cpu_forest.h"

#include <unordered_map>
#include <utility>

#include "collision/geometry/primitive_solid.h"

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
  tree.bounds_solid.reserve(mesh.triangles.size());
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
      tree.bounds_solid.push_back(tree.mesh ? tree.components.bounds_solid[triangle] : 0);
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

std::shared_ptr<const CpuTree> makeTree(const Shape& shape, const Mesh& mesh, const Forest& forest, std::size_t number)
{
  auto tree = std::make_shared<CpuTree>();
  tree->shape = shape;
  tree->mesh = isMesh(shape);
  if (tree->mesh)
  {
    const Node& root = forest.nodes[forest.roots[number]];
    tree->center = centerOf(root);
    tree->half = halfOf(root);
    tree->components = findComponents(mesh);
    for (const Component& component : tree->components.components)
      if (component.closed)
        tree->solid_bounds.extend(component.bounds);
  }
  else
  {
    tree->center.setZero();
    tree->half = halfExtents(shape);
  }
  copyTree(forest, number, mesh, *tree);
  fitBoxes(*tree);
  tree->box = tree->mesh ? tree->nodes[0].box : OrientedBox{Matrix3d::Identity(), tree->center, tree->half};
  return tree;
}
}  // namespace

CpuForest::CpuForest(const CollisionProblem& problem, const Forest& forest) : shapes_(problem.tessellations)
{
  for (std::size_t i = 0; i < shapes_.size(); ++i)
    trees_.push_back(makeTree(problem.shapes[i], *shapes_[i].mesh, forest, i));
}

CpuForest::CpuForest(const CollisionProblem& problem, const CpuForest& previous, const Build& build)
  : trees_(problem.tessellations.size()), shapes_(problem.tessellations)
{
  std::unordered_map<const Mesh*, std::size_t> known;
  for (std::size_t i = 0; i < previous.shapes_.size(); ++i)
    known.emplace(previous.shapes_[i].mesh.get(), i);
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < shapes_.size(); ++i)
  {
    const auto found = known.find(shapes_[i].mesh.get());
    if (found != known.end() && sameShape(previous.trees_[found->second]->shape, problem.shapes[i]))
      trees_[i] = previous.trees_[found->second];
    else
      missing.push_back(i);
  }
  if (missing.empty())
    return;
  std::vector<Tessellation> wanted;
  for (const std::size_t i : missing)
    wanted.push_back(shapes_[i]);
  const Forest forest = build(wanted);
  for (std::size_t k = 0; k < missing.size(); ++k)
    trees_[missing[k]] = makeTree(problem.shapes[missing[k]], *wanted[k].mesh, forest, k);
}
}  // namespace gpu_planning_scene::core
