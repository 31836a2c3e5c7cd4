#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kTargetSagitta = 100e-6;
constexpr std::size_t kMaxTriangles = 1 << 15;

double uniform(std::mt19937_64& generator)
{
  return std::uniform_real_distribution<double>(0.0, 1.0)(generator);
}

// The true surface of a shape, implemented independently: the distance of a point from it, and random points on it.
struct Surface
{
  const char* name;
  Shape shape;
  double size;
  std::function<double(const Eigen::Vector3d&)> off_surface;
  std::function<Eigen::Vector3d(std::mt19937_64&)> sample;
};

Surface sphere(double r)
{
  return {"sphere", Sphere{r}, r, [r](const Eigen::Vector3d& p) { return std::abs(p.norm() - r); },
          [r](std::mt19937_64& g)
          {
            const double z = 2.0 * uniform(g) - 1.0;
            const double angle = 2.0 * M_PI * uniform(g);
            const double rho = std::sqrt(1.0 - z * z);
            return Eigen::Vector3d(r * Eigen::Vector3d(rho * std::cos(angle), rho * std::sin(angle), z));
          }};
}

Eigen::Vector3d onCircle(double radius, double z, std::mt19937_64& g)
{
  const double angle = 2.0 * M_PI * uniform(g);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

Surface cylinder(double r, double length)
{
  return {"cylinder", Cylinder{r, length}, r + length,
          [=](const Eigen::Vector3d& p)
          {
            const double rho = p.head<2>().norm();
            const double side = std::abs(p.z()) <= 0.5 * length ? std::abs(rho - r) : 1.0;
            const double caps = rho <= r * (1.0 + 1e-15) ? std::abs(std::abs(p.z()) - 0.5 * length) : 1.0;
            return std::min(side, caps);
          },
          [=](std::mt19937_64& g)
          {
            const double z = length * (uniform(g) - 0.5);
            const double part = uniform(g);
            if (part < 0.4)
              return onCircle(r, z, g);
            // Half of the samples of the caps lie on the rim, where the tessellation's error is largest.
            const double rho = part < 0.7 ? r : r * std::sqrt(uniform(g));
            return onCircle(rho, std::copysign(0.5 * length, z), g);
          }};
}

Surface cone(double r, double length)
{
  return {"cone", Cone{r, length}, r + length,
          [=](const Eigen::Vector3d& p)
          {
            const double rho = p.head<2>().norm();
            const double side = std::abs(rho - r * (0.5 - p.z() / length));
            const double base = rho <= r * (1.0 + 1e-15) ? std::abs(p.z() + 0.5 * length) : 1.0;
            return std::min(side, base);
          },
          [=](std::mt19937_64& g)
          {
            const double part = uniform(g);
            if (part < 0.3)
              return onCircle(r * std::sqrt(uniform(g)), -0.5 * length, g);
            const double height = part < 0.5 ? 0.0 : part < 0.6 ? 1.0 - 1e-3 * uniform(g) : uniform(g);
            return onCircle(r * (1.0 - height), length * (height - 0.5), g);
          }};
}

std::vector<Surface> surfaces()
{
  return {sphere(0.001),       sphere(0.07),    sphere(0.5),     cylinder(1e-5, 0.1), cylinder(0.04, 1.0),
          cylinder(0.6, 0.02), cone(0.05, 0.2), cone(0.3, 0.01), cone(0.001, 2.0)};
}

double squaredSegmentDistance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  const Eigen::Vector3d ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).squaredNorm();
}

double squaredDistance(const Eigen::Vector3d& p, const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle)
{
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  const Eigen::Vector3d& b = mesh.vertices[triangle[1]];
  const Eigen::Vector3d& c = mesh.vertices[triangle[2]];
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const bool above = n.cross(b - a).dot(p - a) >= 0 && n.cross(c - b).dot(p - b) >= 0 && n.cross(a - c).dot(p - c) >= 0;
  if (above)
    return std::pow(n.dot(p - a), 2) / n.squaredNorm();
  return std::min({squaredSegmentDistance(p, a, b), squaredSegmentDistance(p, b, c), squaredSegmentDistance(p, c, a)});
}

double distance(const Eigen::Vector3d& p, const Mesh& mesh)
{
  double least = std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles)
    least = std::min(least, squaredDistance(p, mesh, triangle));
  return std::sqrt(least);
}

// Every edge has one triangle on each side, in opposite directions. All triangles face outward, and the enclosed volume
// is positive.
void expectClosedAndOutward(const Mesh& mesh, const std::string& name)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0.0;
  for (const auto& t : mesh.triangles)
  {
    for (int i = 0; i < 3; ++i)
      ++edges[{t[i], t[(i + 1) % 3]}];
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    const Eigen::Vector3d normal = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    EXPECT_GT(normal.dot(a), 0.0) << name << ": a triangle faces inward";
    volume += normal.dot(a) / 6.0;
  }
  for (const auto& [edge, count] : edges)
  {
    ASSERT_EQ(count, 1) << name;
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u) << name << " has a hole";
  }
  EXPECT_GT(volume, 0.0) << name;
}

TEST(Tessellation, ABoxIsTwelveTrianglesAndExact)
{
  const Tessellation box = tessellate(Box{{0.2, 0.4, 0.6}});
  EXPECT_EQ(box.mesh->triangles.size(), 12u);
  EXPECT_EQ(box.mesh->vertices.size(), 8u);
  EXPECT_EQ(box.sagitta, 0.0);
  for (const Eigen::Vector3d& vertex : box.mesh->vertices)
    EXPECT_EQ(vertex.cwiseAbs(), Eigen::Vector3d(0.1, 0.2, 0.3));
  expectClosedAndOutward(*box.mesh, "box");
}

TEST(Tessellation, AMeshIsItself)
{
  const auto mesh = std::make_shared<const Mesh>();
  EXPECT_EQ(tessellate(mesh).mesh, mesh);
  EXPECT_EQ(tessellate(mesh).sagitta, 0.0);
}

TEST(Tessellation, CurvedShapesAreClosedAndFaceOutward)
{
  for (const Surface& surface : surfaces())
    expectClosedAndOutward(*tessellate(surface.shape).mesh, surface.name);
}

TEST(Tessellation, VerticesLieOnTheSurface)
{
  for (const Surface& surface : surfaces())
  {
    const Tessellation tessellation = tessellate(surface.shape);
    for (const Eigen::Vector3d& vertex : tessellation.mesh->vertices)
      ASSERT_LE(surface.off_surface(vertex), 4e-16 * surface.size) << surface.name << " " << vertex.transpose();
  }
}

TEST(Tessellation, TheSagittaMeetsTheTargetWithinTheTriangleBudget)
{
  for (const Surface& surface : surfaces())
  {
    const Tessellation tessellation = tessellate(surface.shape);
    EXPECT_LE(tessellation.mesh->triangles.size(), kMaxTriangles) << surface.name;
    const bool out_of_budget = tessellation.mesh->triangles.size() > kMaxTriangles * 0.95;
    EXPECT_TRUE(out_of_budget || tessellation.sagitta <= kTargetSagitta) << surface.name << tessellation.sagitta;
  }
  EXPECT_LE(tessellate(Sphere{0.1}).sagitta, kTargetSagitta);
  EXPECT_LE(tessellate(Cylinder{5.0, 1.0}).sagitta, kTargetSagitta);
  EXPECT_LT(tessellate(Cylinder{0.05, 1.0}).mesh->triangles.size(), 500u);
  EXPECT_LE(tessellate(Cylinder{1e4, 1.0}).mesh->triangles.size(), kMaxTriangles);
  EXPECT_LE(tessellate(Sphere{1e4}).mesh->triangles.size(), kMaxTriangles);
  EXPECT_LE(tessellate(Cone{1e4, 1.0}).mesh->triangles.size(), kMaxTriangles);
}

TEST(Tessellation, NoPointOfTheTrueSurfaceIsFartherThanTheSagitta)
{
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  for (const Surface& surface : surfaces())
  {
    const Tessellation tessellation = tessellate(surface.shape);
    const int samples = static_cast<int>(1 + 3000000 / tessellation.mesh->triangles.size());
    double farthest = 0.0;
    for (int i = 0; i < std::min(samples, 2000); ++i)
      farthest = std::max(farthest, distance(surface.sample(generator), *tessellation.mesh));
    EXPECT_LE(farthest, tessellation.sagitta) << surface.name;
    // The bound is tight enough to be useful.
    EXPECT_GE(farthest, 0.25 * tessellation.sagitta) << surface.name;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
