#include "support/obstacles.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// Two triangles for each cell of a grid of `rows` x `columns` vertices. `closed`: the grid wraps around in both
/// directions.
void addGridTriangles(std::uint32_t rows, std::uint32_t columns, bool closed, Mesh& mesh)
{
  const std::uint32_t open = closed ? 0 : 1;
  for (std::uint32_t i = 0; i + open < rows; ++i)
  {
    for (std::uint32_t j = 0; j + open < columns; ++j)
    {
      const std::uint32_t a = i * columns + j;
      const std::uint32_t b = i * columns + (j + 1) % columns;
      const std::uint32_t c = (i + 1) % rows * columns + j;
      const std::uint32_t d = (i + 1) % rows * columns + (j + 1) % columns;
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }
  }
}

WorldObject boxObject(const std::string& id, const Vector3d& center, const Vector3d& size)
{
  WorldObject object;
  object.id = id;
  object.pose.translation() = center;
  object.shapes.push_back({Box{size}});
  return object;
}
}  // namespace

std::shared_ptr<const Mesh> closedSurface(const std::string& name, std::size_t triangles, double ratio,
                                          const std::function<Vector3d(double, double)>& position)
{
  const double count = 0.5 * static_cast<double>(triangles);
  const auto columns = static_cast<std::uint32_t>(std::max(6.0, std::round(std::sqrt(count * ratio))));
  const auto rings = static_cast<std::uint32_t>(std::max(2.0, std::round(count / columns)));
  auto mesh = std::make_shared<Mesh>();
  mesh->name = name;
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t k = 0; k < columns; ++k)
      mesh->vertices.push_back(position((i + 1.0) / (rings + 1.0), 2.0 * M_PI * k / columns));
  const auto first_end = static_cast<std::uint32_t>(mesh->vertices.size());
  mesh->vertices.push_back(position(0.0, 0.0));
  mesh->vertices.push_back(position(1.0, 0.0));
  const auto at = [&](std::uint32_t ring, std::uint32_t column) { return ring * columns + column % columns; };
  for (std::uint32_t k = 0; k < columns; ++k)
  {
    mesh->triangles.push_back({first_end, at(0, k + 1), at(0, k)});
    for (std::uint32_t i = 0; i + 1 < rings; ++i)
    {
      mesh->triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      mesh->triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
    mesh->triangles.push_back({at(rings - 1, k), at(rings - 1, k + 1), first_end + 1});
  }
  return mesh;
}

std::shared_ptr<const Mesh> torusMesh(double radius, double tube_radius)
{
  constexpr std::uint32_t kAround = 32;
  constexpr std::uint32_t kAcross = 16;
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "torus";
  for (std::uint32_t i = 0; i < kAround; ++i)
  {
    const double u = 2.0 * M_PI * i / kAround;
    for (std::uint32_t j = 0; j < kAcross; ++j)
    {
      const double v = 2.0 * M_PI * j / kAcross;
      const double distance = radius + tube_radius * std::cos(v);
      mesh->vertices.emplace_back(distance * std::cos(u), distance * std::sin(u), tube_radius * std::sin(v));
    }
  }
  addGridTriangles(kAround, kAcross, true, *mesh);
  return mesh;
}

std::shared_ptr<const Mesh> sheetMesh(double size)
{
  constexpr std::uint32_t kSteps = 17;
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "sheet";
  for (std::uint32_t i = 0; i < kSteps; ++i)
  {
    for (std::uint32_t j = 0; j < kSteps; ++j)
    {
      const double x = static_cast<double>(i) / (kSteps - 1) - 0.5;
      const double y = static_cast<double>(j) / (kSteps - 1) - 0.5;
      mesh->vertices.emplace_back(size * x, size * y, 0.1 * size * std::sin(9.0 * x) * std::cos(7.0 * y));
    }
  }
  addGridTriangles(kSteps, kSteps, false, *mesh);
  return mesh;
}

std::vector<WorldObject> boxesAround(const Vector3d& center, std::size_t count, double radius, double size)
{
  std::vector<WorldObject> objects;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count);
    const double height =
        0.5 * radius * std::cos(2.0 * M_PI * 3.0 * static_cast<double>(i) / static_cast<double>(count));
    const Vector3d place = center + Vector3d(radius * std::cos(angle), radius * std::sin(angle), height);
    objects.push_back(boxObject("box_" + std::to_string(i), place, {size, 0.7 * size, 0.5 * size}));
    objects.back().pose.rotate(Eigen::AngleAxisd(angle, Vector3d(0.3, 0.2, 1.0).normalized()));
  }
  return objects;
}

std::vector<WorldObject> shelf(const Vector3d& center, const Vector3d& size, std::size_t boards)
{
  constexpr double kBoard = 0.02;
  const Vector3d middle = center + Vector3d(0.0, 0.0, 0.5 * size.z());
  std::vector<WorldObject> objects = {
      boxObject("back", middle + Vector3d(0.5 * size.x(), 0.0, 0.0), {kBoard, size.y(), size.z()}),
      boxObject("left", middle + Vector3d(0.0, 0.5 * size.y(), 0.0), {size.x(), kBoard, size.z()}),
      boxObject("right", middle - Vector3d(0.0, 0.5 * size.y(), 0.0), {size.x(), kBoard, size.z()})};
  for (std::size_t i = 1; i <= boards; ++i)
  {
    const double height = size.z() * static_cast<double>(i) / static_cast<double>(boards);
    objects.push_back(
        boxObject("board_" + std::to_string(i), center + Vector3d(0.0, 0.0, height), {size.x(), size.y(), kBoard}));
  }
  return objects;
}

std::vector<WorldObject> table(const Vector3d& center, const Vector3d& size)
{
  constexpr double kTop = 0.04;
  constexpr double kLeg = 0.06;
  std::vector<WorldObject> objects = {
      boxObject("top", center - Vector3d(0.0, 0.0, 0.5 * kTop), {size.x(), size.y(), kTop}),
      boxObject("parcel", center + Vector3d(-0.1, 0.3, 0.1), {0.2, 0.2, 0.2}),
      boxObject("screen", center + Vector3d(0.15, 0.0, 0.25), {0.04, 0.6, 0.4})};
  WorldObject cup;
  cup.id = "cup";
  cup.pose.translation() = center + Vector3d(-0.15, -0.2, 0.08);
  cup.shapes.push_back({Cylinder{0.05, 0.15}});
  objects.push_back(cup);
  for (int i = 0; i < 4; ++i)
  {
    const Vector3d corner((i % 2 == 0 ? 0.5 : -0.5) * (size.x() - kLeg), (i < 2 ? 0.5 : -0.5) * (size.y() - kLeg),
                          -0.5 * size.z());
    objects.push_back(boxObject("leg_" + std::to_string(i), center + corner, {kLeg, kLeg, size.z() - 2.0 * kTop}));
  }
  return objects;
}

std::vector<WorldObject> corridor(const Vector3d& center, const Vector3d& size)
{
  constexpr double kWall = 0.1;
  const double wall_at = 0.5 * (size.y() + kWall);
  return {boxObject("left_wall", center + Vector3d(0.0, wall_at, 0.0), {size.x(), kWall, size.z()}),
          boxObject("right_wall", center - Vector3d(0.0, wall_at, 0.0), {size.x(), kWall, size.z()}),
          boxObject("lintel", center + Vector3d(0.3, 0.0, 0.5 * size.z()), {0.2, size.y(), 0.4}),
          boxObject("post", center + Vector3d(0.55, 0.0, 0.0), {kWall, kWall, size.z()})};
}

std::vector<WorldObject> generateObstacles(const ObstacleField& field, std::uint64_t seed)
{
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto random_direction = [&]() -> Vector3d
  { return Vector3d(normal(generator), normal(generator), normal(generator)).normalized(); };
  const auto random_size = [&] { return field.size * (0.3 + 0.7 * share(generator)); };
  const Shape torus = torusMesh(0.35 * field.size, 0.12 * field.size);
  const Shape sheet = sheetMesh(field.size);

  std::vector<WorldObject> objects;
  for (std::size_t i = 0; i < field.count; ++i)
  {
    WorldObject object;
    object.id = "obstacle_" + std::to_string(i);
    const double distance = field.inner_radius + (field.outer_radius - field.inner_radius) * share(generator);
    object.pose.translation() = field.center + distance * random_direction();
    object.pose.linear() =
        Eigen::Quaterniond(normal(generator), normal(generator), normal(generator), normal(generator))
            .normalized()
            .toRotationMatrix();
    const double a = random_size();
    const double b = random_size();
    const double c = random_size();
    switch (i % 6)
    {
      case 0:
        object.shapes.push_back({Box{{a, b, c}}});
        break;
      case 1:
        object.shapes.push_back({Cylinder{0.3 * a, b}});
        break;
      case 2:
        object.shapes.push_back({Sphere{0.4 * a}});
        break;
      case 3:
        object.shapes.push_back({Cone{0.4 * a, b}});
        break;
      case 4:
        object.shapes.push_back({torus});
        break;
      default:
        object.shapes.push_back({sheet});
    }
    objects.push_back(std::move(object));
  }
  return objects;
}
}  // namespace gpu_planning_scene::core
