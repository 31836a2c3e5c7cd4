#include "collision/contacts/colliding_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "support/triangle_soup.h"

namespace gpu_planning_scene::core
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

double between(Random& random, double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vector3d randomDirection(Random& random)
{
  std::normal_distribution<double> normal;
  return Vector3d(normal(random), normal(random), normal(random)).normalized();
}

namespace
{
/// Boxes in one mesh, each a closed component.
std::shared_ptr<const Mesh> meshOfBoxes(const std::vector<std::array<Vector3d, 2>>& boxes)
{
  auto mesh = std::make_shared<Mesh>();
  for (const auto& [size, center] : boxes)
  {
    const Mesh box = *tessellate(Box{size}).mesh;
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    for (const Vector3d& vertex : box.vertices)
      mesh->vertices.push_back(vertex + center);
    for (const auto& t : box.triangles)
      mesh->triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

/// A closed mesh whose cross section in x and y is an L.
std::shared_ptr<const Mesh> meshOfL(double size)
{
  auto mesh = std::make_shared<Mesh>();
  const std::array<std::array<double, 2>, 6> outline = {{{0, 0}, {1, 0}, {1, 0.3}, {0.3, 0.3}, {0.3, 1}, {0, 1}}};
  for (const double z : {-0.25, 0.25})
    for (const auto& [x, y] : outline)
      mesh->vertices.push_back(size * Vector3d(x - 0.5, y - 0.5, z));
  for (const auto& [i, j, k] : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}})
  {
    mesh->triangles.push_back({i, k, j});
    mesh->triangles.push_back({i + 6, j + 6, k + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i)
  {
    const std::uint32_t j = (i + 1) % 6;
    mesh->triangles.push_back({i, j, j + 6});
    mesh->triangles.push_back({i, j + 6, i + 6});
  }
  return mesh;
}

/// A mesh without its last triangles.
std::shared_ptr<const Mesh> opened(const Shape& shape, std::size_t missing)
{
  auto mesh = std::make_shared<Mesh>(*tessellate(shape).mesh);
  mesh->triangles.resize(mesh->triangles.size() - missing);
  return mesh;
}
}  // namespace

std::vector<Kind> kinds()
{
  const auto box = [](Random& r) { return Box{{between(r, 0.1, 0.6), between(r, 0.1, 0.6), between(r, 0.1, 0.6)}}; };
  const auto cylinder = [](Random& r) { return Cylinder{between(r, 0.05, 0.3), between(r, 0.1, 0.6)}; };
  const auto soup = [](Random& r)
  {
    return triangleSoup(
        8, [&r] { return Vector3d(between(r, -0.3, 0.3), between(r, -0.3, 0.3), between(r, -0.3, 0.3)); });
  };
  return {
      {"box", true, box},
      {"sphere", true, [](Random& r) { return Sphere{between(r, 0.05, 0.3)}; }},
      {"cylinder", true, cylinder},
      {"cone", true,
       [](Random& r) {
         return Cone{between(r, 0.05, 0.3), between(r, 0.1, 0.6)};
       }},
      {"mesh of a box", true, [=](Random& r) { return tessellate(box(r)).mesh; }},
      {"mesh of a cylinder", true, [=](Random& r) { return tessellate(cylinder(r)).mesh; }},
      {"mesh of an L", false, [](Random& r) { return meshOfL(between(r, 0.2, 0.6)); }},
      {"mesh of a table", false,
       [](Random&)
       {
         return meshOfBoxes({{Vector3d(0.6, 0.6, 0.05), Vector3d(0, 0, 0.2)},
                             {Vector3d(0.05, 0.05, 0.4), Vector3d(0.25, 0.25, 0)},
                             {Vector3d(0.05, 0.05, 0.4), Vector3d(-0.25, -0.25, 0)}});
       }},
      {"open mesh of a box", false, [=](Random& r) { return opened(box(r), 2); }},
      {"triangles", false, soup},
  };
}

Kind halfSpaces()
{
  return {"half-space", false, [](Random& r) { return HalfSpace{randomDirection(r), between(r, -0.5, 0.5)}; }};
}

CollidingPoses::CollidingPoses(const Shape& held, const std::vector<PlacedShape>& object, double padding,
                               std::uint64_t seed)
  : moving_(held, object, {0.0, padding}), first_(object.front()), random_(seed)
{
}

std::optional<Isometry3d> CollidingPoses::next()
{
  for (int attempt = 0; attempt < 100; ++attempt)
  {
    Isometry3d pose = randomPose(random_, 0.0);
    const Vector3d from = randomDirection(random_);
    Vector3d goal = first_.pose.translation() + 0.1 * randomDirection(random_);
    if (const auto* plane = std::get_if<HalfSpace>(&first_.shape))
      goal -= (plane->normal.dot(goal) - plane->offset) * plane->normal + 0.3 * plane->normal;
    double free = 1.5;
    double colliding = 0.0;
    const auto collides = [&](double distance)
    {
      pose.translation() = goal + distance * from;
      return moving_.collides(pose);
    };
    if (!collides(colliding) || collides(free))
      continue;
    for (int i = 0; i < 20; ++i)
    {
      const double middle = 0.5 * (free + colliding);
      (collides(middle) ? colliding : free) = middle;
    }
    // Depths from 0.1 micrometres to the sizes of the shapes.
    const double depth = std::pow(10.0, between(random_, -7.0, -0.5));
    if (collides(std::max(0.0, colliding - depth)))
      return pose;
  }
  return std::nullopt;
}

oracle::Motion motionOf(const Isometry3d& pose)
{
  return oracle::Motion(pose);
}

/// The distance of a point from a shape, by the oracle.
double distanceTo(const oracle::PreparedShape& shape, const Isometry3d& pose, const Vector3d& point)
{
  static const oracle::PreparedShape tiny{Shape(Sphere{1e-12})};
  return oracle::distance(shape, motionOf(pose), tiny, motionOf(Isometry3d(Eigen::Translation3d(point))));
}
}  // namespace gpu_planning_scene::core
