// A component of a mesh inside a primitive or a mesh is a collision, whichever component it is.

#include <gtest/gtest.h>

#include "gpu_planning_scene/mesh_pair_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Adds a mesh moved by `offset`; vertices are not shared.
void append(Mesh& mesh, const Mesh& other, const Eigen::Vector3d& offset)
{
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : other.vertices)
    mesh.vertices.push_back(vertex + offset);
  for (const auto& t : other.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// Two small balls, the second one 0.3 m from the first.
std::shared_ptr<const Mesh> twoBalls()
{
  auto mesh = std::make_shared<Mesh>();
  const auto ball = tessellate(Sphere{0.01}).mesh;
  append(*mesh, *ball, Eigen::Vector3d::Zero());
  append(*mesh, *ball, {0.3, 0.0, 0.0});
  return mesh;
}

class Containment : public testing::TestWithParam<std::tuple<Traversal, Shape>>
{
};

TEST_P(Containment, OfOneComponentIsACollision)
{
  BatchCheckerOptions options;
  options.traversal = std::get<0>(GetParam());
  const Shape& solid = std::get<1>(GetParam());
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, 0.0)); };
  // The first ball is inside, then the second ball, then none; in both orders of the shapes.
  EXPECT_EQ(MeshPairChecker(solid, twoBalls(), options).collide({at(0.02), at(-0.28), at(0.4), at(-0.15)}),
            (std::vector<std::uint8_t>{1, 1, 0, 0}));
  EXPECT_EQ(MeshPairChecker(twoBalls(), solid, options).collide({at(-0.02), at(0.28), at(-0.4), at(0.15)}),
            (std::vector<std::uint8_t>{1, 1, 0, 0}));
}

INSTANTIATE_TEST_SUITE_P(Solids, Containment,
                         testing::Combine(testing::Values(Traversal::BreadthFirst, Traversal::WorkQueue),
                                          testing::Values(Shape(Box{{0.1, 0.1, 0.1}}), Shape(Sphere{0.06}),
                                                          Shape(Cylinder{0.06, 0.1}), Shape(Cone{0.12, 0.2}))));
}  // namespace
}  // namespace gpu_planning_scene::core
