#include "collision/cpu_forest.h"

#include <utility>

#include "collision/primitive_solid.h"

namespace gpu_planning_scene
{
CpuForest::CpuForest(const CollisionProblem& problem, std::shared_ptr<const Forest> forest)
  : forest_(std::move(forest)), shapes_(problem.shapes)
{
  std::vector<std::vector<std::uint8_t>> bounds_solid;  // of each tree's triangles
  for (std::size_t i = 0; i < shapes_.size(); ++i)
  {
    const std::uint32_t root = forest_->roots[i];
    bounds_solid.emplace_back();
    if (!isMesh(shapes_[i]))
    {
      trees_.push_back({root, Eigen::Vector3d::Zero(), halfExtents(shapes_[i]), false, {}, {}});
      continue;
    }
    MeshComponents found = findComponents(*problem.trees[i].mesh);
    Eigen::AlignedBox3d solid_bounds;
    for (const Component& component : found.components)
    {
      if (component.closed)
      {
        solid_bounds.extend(component.bounds);
      }
    }
    const Node& box = forest_->nodes[root];
    trees_.push_back({root, centerOf(box), halfOf(box), true, std::move(found.components), solid_bounds});
    bounds_solid.back() = std::move(found.bounds_solid);
  }

  // The forest may hold more trees than these.
  triangles_.resize(forest_->leaf_triangles.size());
  bounds_solid_.resize(forest_->leaf_triangles.size());
  std::vector<std::uint32_t> open;
  for (std::size_t tree = 0; tree < shapes_.size(); ++tree)
  {
    const Mesh& mesh = *problem.trees[tree].mesh;
    open.assign(1, forest_->roots[tree]);
    while (!open.empty())
    {
      const Node& node = forest_->nodes[open.back()];
      open.pop_back();
      if (node.count == 0)
      {
        open.insert(open.end(), {node.first, node.first + 1});
      }
      for (std::uint32_t place = node.first; place < node.first + node.count; ++place)
      {
        const std::uint32_t triangle = forest_->leaf_triangles[place] - forest_->first_triangle[tree];
        const auto& corners = mesh.triangles[triangle];
        triangles_[place] = {mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]};
        bounds_solid_[place] = trees_[tree].mesh ? bounds_solid[tree][triangle] : 0;
      }
    }
  }
}
}  // namespace gpu_planning_scene
