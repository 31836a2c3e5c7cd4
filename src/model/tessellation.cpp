#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "base/math_constants.h"
#include "gpu_planning_scene/shapes.h"
#include "gpu_planning_scene/solids.h"

// Triangles for solids: boxes exactly, cylinders and cones by inscribed regular polygons, spheres by a subdivided
// icosahedron (M. J. Wenninger: Spherical Models, 1979). All vertices are on the true surface. The sagitta is the
// largest distance from the true surface to the triangles.
namespace gpu_planning_scene::core
{
namespace
{
constexpr double kTargetSagitta = 100e-6;  // metres
constexpr int kMaxTriangles = 1 << 15;

// Upper bound of a vertex's distance from the true surface: a few rounding errors of numbers of the shape's size.
double roundingSlack(double size)
{
  return 16.0 * std::numeric_limits<double>::epsilon() * size;
}

std::shared_ptr<Mesh> emptyMesh(const char* name)
{
  auto mesh = std::make_shared<Mesh>();
  mesh->name = name;
  return mesh;
}

Tessellation tessellateBox(const Box& box)
{
  auto mesh = emptyMesh("box");
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
    mesh->vertices.push_back(sign.cwiseProduct(box.size));
  }
  mesh->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return {mesh, 0.0};
}

// Adds the corners of a regular polygon with `sides` sides, inscribed in a circle. Returns the index of the first
// corner.
std::uint32_t addRing(Mesh& mesh, double radius, double z, int sides)
{
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < sides; ++i)
  {
    const double angle = 2.0 * kPi * i / sides;
    mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return first;
}

// Adds triangles from each side of a ring to one vertex. Seen from outside, they run anticlockwise. `upwards`: the
// outside is on the +z side of the fan.
void addFan(Mesh& mesh, std::uint32_t ring, std::uint32_t vertex, int sides, bool upwards)
{
  for (int i = 0; i < sides; ++i)
  {
    const std::uint32_t a = ring + i;
    const std::uint32_t b = ring + (i + 1) % sides;
    mesh.triangles.push_back(upwards ? std::array<std::uint32_t, 3>{a, b, vertex}
                                     : std::array<std::uint32_t, 3>{b, a, vertex});
  }
}

std::uint32_t addVertex(Mesh& mesh, const Eigen::Vector3d& vertex)
{
  mesh.vertices.push_back(vertex);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

// In a regular polygon with n sides, inscribed in a circle of radius r, the middle of a side is r cos(pi / n) from the
// centre. So no point of the disk is farther from the polygon than r (1 - cos(pi/n)) = 2 r sin^2(pi/(2n)).
double ringSagitta(double radius, int sides)
{
  const double half_angle_sine = std::sin(kPi / (2.0 * sides));
  return 2.0 * radius * half_angle_sine * half_angle_sine + roundingSlack(radius);
}

int ringSides(double radius, int max_sides)
{
  const double sine = std::sqrt(std::min(0.25, kTargetSagitta / (2.0 * radius)));
  int sides = std::clamp(static_cast<int>(std::min<double>(kPi / (2.0 * std::asin(sine)), max_sides)), 3, max_sides);
  while (sides < max_sides && ringSagitta(radius, sides) > kTargetSagitta)
    ++sides;
  return sides;
}

// Each horizontal slice of the solid is the same disk, and each slice of the tessellation the same inscribed polygon.
// So the polygon's sagitta holds for the side and for both caps.
Tessellation tessellateCylinder(const Cylinder& cylinder)
{
  auto mesh = emptyMesh("cylinder");
  const int sides = ringSides(cylinder.radius, kMaxTriangles / 4);
  const double top_z = 0.5 * cylinder.length;
  const std::uint32_t bottom = addRing(*mesh, cylinder.radius, -top_z, sides);
  const std::uint32_t top = addRing(*mesh, cylinder.radius, top_z, sides);
  addFan(*mesh, bottom, addVertex(*mesh, {0.0, 0.0, -top_z}), sides, false);
  addFan(*mesh, top, addVertex(*mesh, {0.0, 0.0, top_z}), sides, true);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(sides); ++i)
  {
    const std::uint32_t next = (i + 1) % sides;
    mesh->triangles.push_back({bottom + i, bottom + next, top + next});
    mesh->triangles.push_back({bottom + i, top + next, top + i});
  }
  return {mesh, ringSagitta(cylinder.radius, sides)};
}

// At height z, the slice of the solid is a disk of radius rho <= r, and the slice of the tessellation the inscribed
// polygon of that radius. So no point of the slice is farther than rho (1 - cos(pi / n)): the rim of the base has the
// largest value, the apex has 0.
Tessellation tessellateCone(const Cone& cone)
{
  auto mesh = emptyMesh("cone");
  const int sides = ringSides(cone.radius, kMaxTriangles / 2);
  const double top_z = 0.5 * cone.length;
  const std::uint32_t base = addRing(*mesh, cone.radius, -top_z, sides);
  addFan(*mesh, base, addVertex(*mesh, {0.0, 0.0, -top_z}), sides, false);
  addFan(*mesh, base, addVertex(*mesh, {0.0, 0.0, top_z}), sides, true);
  return {mesh, ringSagitta(cone.radius, sides)};
}

// The faces of an icosahedron, each divided into `frequency`^2 triangles and projected to the unit sphere.
class Geodesic
{
  using Weights = std::array<std::pair<int, int>, 3>;  // corner of the icosahedron and its weight

 public:
  explicit Geodesic(int frequency) : frequency_(frequency)
  {
    const double golden = 0.5 * (1.0 + std::sqrt(5.0));
    const std::array<Eigen::Vector3d, 12> corners = {
        Eigen::Vector3d(-1, golden, 0),  Eigen::Vector3d(1, golden, 0),   Eigen::Vector3d(-1, -golden, 0),
        Eigen::Vector3d(1, -golden, 0),  Eigen::Vector3d(0, -1, golden),  Eigen::Vector3d(0, 1, golden),
        Eigen::Vector3d(0, -1, -golden), Eigen::Vector3d(0, 1, -golden),  Eigen::Vector3d(golden, 0, -1),
        Eigen::Vector3d(golden, 0, 1),   Eigen::Vector3d(-golden, 0, -1), Eigen::Vector3d(-golden, 0, 1)};
    const std::array<std::array<int, 3>, 20> faces = {{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                       {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                       {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                       {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};
    for (const auto& face : faces)
      addFace(corners, face);
  }

  std::vector<Eigen::Vector3d> vertices;  // of length 1
  std::vector<std::array<std::uint32_t, 3>> triangles;

 private:
  void addFace(const std::array<Eigen::Vector3d, 12>& corners, const std::array<int, 3>& face)
  {
    const int n = frequency_;
    std::vector<std::vector<std::uint32_t>> rows(n + 1);
    for (int row = 0; row <= n; ++row)
      for (int column = 0; column <= n - row; ++column)
        rows[row].push_back(vertex(corners, face, row, column));
    for (int row = 0; row < n; ++row)
    {
      for (int column = 0; column < n - row; ++column)
      {
        triangles.push_back({rows[row][column], rows[row][column + 1], rows[row + 1][column]});
        if (column + 1 < n - row)
          triangles.push_back({rows[row][column + 1], rows[row + 1][column + 1], rows[row + 1][column]});
      }
    }
  }

  // Vertices on the edges of the icosahedron belong to several faces. The weights of its 12 corners identify such a
  // vertex.
  std::uint32_t vertex(const std::array<Eigen::Vector3d, 12>& corners, const std::array<int, 3>& face, int row,
                       int column)
  {
    Weights weights = {std::pair(face[0], frequency_ - row - column), std::pair(face[1], column),
                       std::pair(face[2], row)};
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    bool on_edge = false;
    for (auto& [corner, weight] : weights)
    {
      sum += weight * corners[corner];
      if (weight == 0)
      {
        on_edge = true;
        corner = -1;  // the faces on both sides of an edge have different third corners
      }
    }
    const auto next = static_cast<std::uint32_t>(vertices.size());
    if (on_edge)
    {
      std::sort(weights.begin(), weights.end());
      const auto [known, is_new] = on_edges_.emplace(weights, next);
      if (!is_new)
        return known->second;
    }
    vertices.push_back(sum.normalized());
    return next;
  }

  int frequency_;
  std::map<Weights, std::uint32_t> on_edges_;
};

// A ray from the centre meets the sphere at distance 1. Before that it meets a triangle, at least at the distance of
// the triangle's plane. So no point of the sphere is farther from the tessellation than 1 - (least distance of a
// plane).
double unitSagitta(const Geodesic& sphere)
{
  double least = 1.0;
  for (const auto& [a, b, c] : sphere.triangles)
  {
    const Eigen::Vector3d& corner = sphere.vertices[a];
    const Eigen::Vector3d normal = (sphere.vertices[b] - corner).cross(sphere.vertices[c] - corner).normalized();
    least = std::min(least, normal.dot(corner));
  }
  return 1.0 - least;
}

Tessellation tessellateSphere(const Sphere& sphere)
{
  const int max_frequency = static_cast<int>(std::sqrt(kMaxTriangles / 20.0));
  // The widest triangle has a circumradius of about 0.764 / frequency. So the sagitta is about 0.292 r / frequency^2.
  const double estimate = std::ceil(std::sqrt(0.292 * sphere.radius / kTargetSagitta));
  int frequency = static_cast<int>(std::clamp<double>(estimate, 1.0, max_frequency));
  for (;; ++frequency)
  {
    const Geodesic unit(frequency);
    // The slack also covers the rounding of the plane's distance: the normal comes from edges as short as 1/40.
    const double sagitta = sphere.radius * unitSagitta(unit) + 64.0 * roundingSlack(sphere.radius);
    if (sagitta <= kTargetSagitta || frequency >= max_frequency)
    {
      auto mesh = emptyMesh("sphere");
      mesh->triangles = unit.triangles;
      for (const Eigen::Vector3d& vertex : unit.vertices)
        mesh->vertices.push_back(sphere.radius * vertex);
      return {mesh, sagitta};
    }
  }
}

struct Tessellator
{
  Tessellation operator()(const Box& box) const { return tessellateBox(box); }
  Tessellation operator()(const Sphere& sphere) const { return tessellateSphere(sphere); }
  Tessellation operator()(const Cylinder& cylinder) const { return tessellateCylinder(cylinder); }
  Tessellation operator()(const Cone& cone) const { return tessellateCone(cone); }
  Tessellation operator()(const std::shared_ptr<const Mesh>& mesh) const
  {
    std::shared_ptr<const SolidMesh> solid = solidMeshOf(mesh);
    // Whoever holds the triangles holds the solid too, so that the mesh is not closed again.
    return {std::shared_ptr<const Mesh>(solid, solid->mesh.get()), 0.0, solid};
  }
  Tessellation operator()(const HalfSpace& /*half_space*/) const
  {
    throw std::logic_error("a half-space has no finite surface");
  }
};
}  // namespace

Tessellation tessellate(const Shape& shape)
{
  return std::visit(Tessellator{}, shape);
}
}  // namespace gpu_planning_scene::core
