#include "collision/cpu_forest.h"

#include <unordered_map>
#include <utility>

#include "collision/primitive_solid.h"

namespace gpu_planning_scene
{
namespace
{
/// Copies a tree out of a forest, depth first, so that what is walked together lies together.
void copyTree(const Forest& forest, std::size_t number, const Mesh& mesh, CpuTree& tree)
{
  tree.triangles.reserve(mesh.triangles.size());
  tree.bounds_solid.reserve(mesh.triangles.size());
  tree.nodes.assign(1, forest.nodes[forest.roots[number]]);
  std::vector<std::uint32_t> open = {0};
  while (!open.empty())
  {
    const std::uint32_t at = open.back();
    open.pop_back();
    const Node node = tree.nodes[at];
    if (node.count == 0)
    {
      const auto children = static_cast<std::uint32_t>(tree.nodes.size());
      tree.nodes[at].first = children;
      tree.nodes.push_back(forest.nodes[node.first]);
      tree.nodes.push_back(forest.nodes[node.first + 1]);
      open.insert(open.end(), {children + 1, children});
      continue;
    }
    tree.nodes[at].first = static_cast<std::uint32_t>(tree.triangles.size());
    for (std::uint32_t place = node.first; place < node.first + node.count; ++place)
    {
      const std::uint32_t triangle = forest.leaf_triangles[place] - forest.first_triangle[number];
      const auto& corners = mesh.triangles[triangle];
      tree.triangles.push_back({mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]});
      tree.bounds_solid.push_back(tree.mesh ? tree.parts.bounds_solid[triangle] : 0);
    }
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
    tree->parts = findComponents(mesh);
    for (const Component& component : tree->parts.components)
      if (component.closed)
        tree->solid_bounds.extend(component.bounds);
  }
  else
  {
    tree->center.setZero();
    tree->half = halfExtents(shape);
  }
  copyTree(forest, number, mesh, *tree);
  return tree;
}
}  // namespace

CpuForest::CpuForest(const CollisionProblem& problem, const Forest& forest) : shapes_(problem.trees)
{
  for (std::size_t i = 0; i < shapes_.size(); ++i)
    trees_.push_back(makeTree(problem.shapes[i], *shapes_[i].mesh, forest, i));
}

CpuForest::CpuForest(const CollisionProblem& problem, const CpuForest& previous, const Build& build)
  : trees_(problem.trees.size()), shapes_(problem.trees)
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
}  // namespace gpu_planning_scene
