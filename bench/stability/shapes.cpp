#include "stability/shapes.h"

#include <algorithm>

namespace gpu_planning_scene::core::stability
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
}  // namespace

MeshPtr makeMesh(std::vector<Eigen::Vector3d> vertices, std::vector<std::array<std::uint32_t, 3>> triangles)
{
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "case";
  mesh->vertices = std::move(vertices);
  mesh->triangles = std::move(triangles);
  return mesh;
}

MeshPtr triangleMesh(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return makeMesh({a, b, c}, {{0, 1, 2}});
}

MeshPtr randomTriangle(Random& random)
{
  return triangleMesh(random.inCube(0.5), random.inCube(0.5), random.inCube(0.5));
}

MeshPtr sliver(Random& random, double aspect)
{
  const double half = random.uniform(0.4, 0.6);
  const Eigen::Isometry3d pose(random.rotation());
  return triangleMesh(pose * Eigen::Vector3d(-half, 0.0, 0.0), pose * Eigen::Vector3d(half, 0.0, 0.0),
                      pose * Eigen::Vector3d(random.uniform(-half, half), aspect, 0.0));
}

MeshPtr randomTetrahedron(Random& random)
{
  for (;;)
  {
    std::vector<Eigen::Vector3d> p = {random.inCube(0.5), random.inCube(0.5), random.inCube(0.5), random.inCube(0.5)};
    const double volume = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
    if (volume > 0.02)
      return makeMesh(std::move(p), {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  }
}

MeshPtr boxMesh(const Eigen::Vector3d& size)
{
  return tessellate(Box{size}).mesh;
}

MeshPtr bumpyBall(Random& random, int rings)
{
  const int sides = 2 * rings;
  std::vector<Eigen::Vector3d> vertices = {{0.0, 0.0, -0.5}, {0.0, 0.0, 0.5}};
  for (int ring = 1; ring < rings; ++ring)
  {
    for (int side = 0; side < sides; ++side)
    {
      const double polar = kPi * ring / rings;
      const double around = 2.0 * kPi * side / sides;
      const double radius = random.uniform(0.4, 0.5);
      vertices.emplace_back(radius * std::sin(polar) * std::cos(around), radius * std::sin(polar) * std::sin(around),
                            -radius * std::cos(polar));
    }
  }
  const auto at = [&](int ring, int side) { return static_cast<std::uint32_t>(2 + (ring - 1) * sides + side % sides); };
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int side = 0; side < sides; ++side)
  {
    triangles.push_back({0, at(1, side + 1), at(1, side)});
    triangles.push_back({1, at(rings - 1, side), at(rings - 1, side + 1)});
    for (int ring = 1; ring + 1 < rings; ++ring)
    {
      triangles.push_back({at(ring, side), at(ring, side + 1), at(ring + 1, side + 1)});
      triangles.push_back({at(ring, side), at(ring + 1, side + 1), at(ring + 1, side)});
    }
  }
  return makeMesh(std::move(vertices), std::move(triangles));
}

MeshPtr inverted(const Mesh& mesh)
{
  auto triangles = mesh.triangles;
  for (auto& t : triangles)
    std::swap(t[0], t[1]);
  return makeMesh(mesh.vertices, std::move(triangles));
}

MeshPtr mirrored(const Mesh& mesh)
{
  auto vertices = mesh.vertices;
  for (Eigen::Vector3d& v : vertices)
    v.x() = -v.x();
  return makeMesh(std::move(vertices), mesh.triangles);
}

MeshPtr scaled(const Mesh& mesh, double factor)
{
  auto vertices = mesh.vertices;
  for (Eigen::Vector3d& v : vertices)
    v *= factor;
  return makeMesh(std::move(vertices), mesh.triangles);
}

MeshPtr moved(const Mesh& mesh, const Eigen::Isometry3d& pose)
{
  auto vertices = mesh.vertices;
  for (Eigen::Vector3d& v : vertices)
    v = pose * v;
  return makeMesh(std::move(vertices), mesh.triangles);
}

MeshPtr joined(const Mesh& first, const Mesh& second)
{
  auto vertices = first.vertices;
  auto triangles = first.triangles;
  const auto shift = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), second.vertices.begin(), second.vertices.end());
  for (const auto& t : second.triangles)
    triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return makeMesh(std::move(vertices), std::move(triangles));
}

MeshPtr without(const Mesh& mesh, std::size_t triangle)
{
  auto triangles = mesh.triangles;
  triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(triangle % triangles.size()));
  return makeMesh(mesh.vertices, std::move(triangles));
}

MeshPtr reordered(const Mesh& mesh, int corner_order)
{
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  auto triangles = mesh.triangles;
  for (auto& t : triangles)
  {
    const auto corners = t;
    for (int i = 0; i < 3; ++i)
      t[i] = corners[kOrders[corner_order][i]];
  }
  std::reverse(triangles.begin(), triangles.end());
  return makeMesh(mesh.vertices, std::move(triangles));
}
Eigen::Vector3d randomSize(Random& random)
{
  return {random.uniform(0.2, 1.0), random.uniform(0.2, 1.0), random.uniform(0.2, 1.0)};
}

MeshPtr randomClosed(Random& random)
{
  switch (random.below(3))
  {
    case 0:
      return randomTetrahedron(random);
    case 1:
      return boxMesh(randomSize(random));
    default:
      return bumpyBall(random, 4);
  }
}

MeshPtr hollowBox(double cavity)
{
  return joined(*boxMesh(Eigen::Vector3d::Ones()), *inverted(*boxMesh(Eigen::Vector3d::Constant(cavity))));
}

MeshPtr damagedBall(Random& random)
{
  const MeshPtr ball = bumpyBall(random, 4);
  auto vertices = ball->vertices;
  auto triangles = ball->triangles;
  auto& some = triangles[random.below(static_cast<int>(triangles.size()))];
  switch (random.below(4))
  {
    case 0:  // a crack: one corner becomes a new vertex, 1e-9 ... 1e-3 m away
      vertices.push_back(vertices[some[0]] + random.logUniform(1e-9, 1e-3) * random.direction());
      some[0] = static_cast<std::uint32_t>(vertices.size() - 1);
      break;
    case 1:
      std::swap(some[0], some[1]);
      break;
    case 2:
    {
      const auto copy = some;
      triangles.push_back(copy);
      break;
    }
    default:
      vertices[some[0]] = -1.2 * vertices[some[0]];
      break;
  }
  return makeMesh(std::move(vertices), std::move(triangles));
}

}  // namespace gpu_planning_scene::core::stability
