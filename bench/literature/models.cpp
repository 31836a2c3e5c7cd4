#include "literature/models.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "model/real_robots.h"
#include "support/obstacles.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Vector3d;

constexpr double kRadius = 0.5;
constexpr double kTorusTube = 0.15;  // the torus has a diameter of 2 kRadius
constexpr std::size_t kPipes = 40;

Vector3d onSphere(double along, double angle)
{
  const double down = M_PI * along;
  return {std::sin(down) * std::cos(angle), std::sin(down) * std::sin(angle), -std::cos(down)};
}

/// The sphere, pressed towards a box: the larger the exponent, the sharper the edges.
Vector3d onRoundedBox(double along, double angle, double exponent)
{
  const Vector3d direction = onSphere(along, angle);
  const double norm = std::pow(direction.cwiseAbs().array().pow(exponent).sum(), 1.0 / exponent);
  return direction / norm;
}

/// `triangles`: roughly. `tube`: radius of the tube, for a torus around z whose outer radius is 1.
std::shared_ptr<const Mesh> torus(std::size_t triangles, double tube)
{
  const double ring = 1.0 - tube;
  const double cells = 0.5 * static_cast<double>(triangles);
  const auto around = static_cast<std::uint32_t>(std::max(8.0, std::round(std::sqrt(cells * ring / tube))));
  const auto across = static_cast<std::uint32_t>(std::max(6.0, std::round(cells / around)));
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "torus";
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t k = 0; k < across; ++k)
    {
      const double u = 2.0 * M_PI * i / around;
      const double v = 2.0 * M_PI * k / across;
      const double away = ring + tube * std::cos(v);
      mesh->vertices.emplace_back(away * std::cos(u), away * std::sin(u), tube * std::sin(v));
      const auto at = [&](std::uint32_t row, std::uint32_t column) { return row % around * across + column % across; };
      mesh->triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh->triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return mesh;
}

/// Adds a part, scaled and placed, to a mesh.
void add(const Mesh& part, const Vector3d& scale, const Eigen::Isometry3d& pose, Mesh& mesh)
{
  const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3d& vertex : part.vertices)
    mesh.vertices.push_back(pose * scale.cwiseProduct(vertex));
  for (const auto& t : part.triangles)
    mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
}

std::shared_ptr<const Mesh> roundedBox(std::size_t triangles, double exponent)
{
  return closedSurface(
      "part", triangles, 2.0, [exponent](double along, double angle) { return onRoundedBox(along, angle, exponent); });
}

/// A thin body, four wheels with tyres, and many small parts between the floor and the roof. All parts are closed.
std::shared_ptr<const Mesh> car(std::size_t triangles, std::uint64_t seed)
{
  constexpr std::size_t kParts = 60;
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double lower, double upper)
  { return std::uniform_real_distribution<double>(lower, upper)(generator); };
  const auto at = [](const Vector3d& place) { return Eigen::Isometry3d(Eigen::Translation3d(place)); };
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "car";
  // A third of the triangles is in the panels, a sixth in the wheels, half in the parts.
  const std::size_t panel = triangles / 3 / 5;
  const std::shared_ptr<const Mesh> sheet = roundedBox(panel, 8.0);
  add(*sheet, {0.5, 0.21, 0.005}, at({0.0, 0.0, -0.12}), *mesh);
  add(*sheet, {0.25, 0.18, 0.005}, at({-0.05, 0.0, 0.13}), *mesh);
  add(*sheet, {0.48, 0.005, 0.09}, at({0.0, 0.21, -0.03}), *mesh);
  add(*sheet, {0.48, 0.005, 0.09}, at({0.0, -0.21, -0.03}), *mesh);
  add(*sheet, {0.11, 0.19, 0.005}, at({0.37, 0.0, 0.04}), *mesh);
  const std::shared_ptr<const Mesh> tyre = torus(triangles / 6 / 4, 0.3);
  for (const double x : {-0.3, 0.3})
    for (const double y : {-0.19, 0.19})
      add(*tyre, Vector3d::Constant(0.09), at({x, y, -0.13}) * Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitX()), *mesh);
  for (std::size_t i = 0; i < kParts; ++i)
  {
    const Vector3d scale(uniform(0.01, 0.06), uniform(0.01, 0.05), uniform(0.01, 0.04));
    Eigen::Isometry3d pose = at({uniform(-0.42, 0.42), uniform(-0.15, 0.15), uniform(-0.08, 0.06)});
    pose.rotate(Eigen::AngleAxisd(uniform(-M_PI, M_PI), Vector3d(uniform(-1, 1), uniform(-1, 1), 1.0).normalized()));
    add(*(i % 4 == 0 ? torus(triangles / 2 / kParts, uniform(0.2, 0.45))
                     : roundedBox(triangles / 2 / kParts, uniform(2.0, 10.0))),
        scale, pose, *mesh);
  }
  return mesh;
}

/// Bent pipes side by side, which cross each other in the middle.
std::shared_ptr<const Mesh> pipes(std::size_t triangles, std::uint64_t seed)
{
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double lower, double upper)
  { return std::uniform_real_distribution<double>(lower, upper)(generator); };
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "pipes";
  for (std::size_t i = 0; i < kPipes; ++i)
  {
    const double radius = uniform(0.006, 0.015);
    const Vector3d start(0.0, uniform(-0.3, 0.3), uniform(-0.3, 0.3));
    const Vector3d bend(0.0, uniform(-0.15, 0.15), uniform(-0.15, 0.15));
    const Vector3d wave(0.0, uniform(-0.03, 0.03), uniform(-0.03, 0.03));
    const double waves = uniform(1.0, 5.0);
    // The ends are closed: the radius shrinks to 0 in the first and the last hundredth of the length.
    add(*closedSurface("pipe", triangles / kPipes, 2.0 * M_PI * radius,
                       [&](double along, double angle) -> Vector3d
                       {
                         const double end = std::min({1.0, 100.0 * along, 100.0 * (1.0 - along)});
                         const Vector3d middle = start + Vector3d(along - 0.5, 0.0, 0.0) +
                                                 std::sin(M_PI * along) * bend +
                                                 std::sin(2.0 * M_PI * waves * along) * wave;
                         return middle + radius * end * Vector3d(0.0, std::cos(angle), std::sin(angle));
                       }),
        Vector3d::Ones(), Eigen::Isometry3d::Identity(), *mesh);
  }
  return mesh;
}

Model centred(const std::string& name, const Mesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  auto moved = std::make_shared<Mesh>(mesh);
  for (Vector3d& vertex : moved->vertices)
    vertex -= box.center();
  moved->name = name;
  Model model;
  model.name = name;
  model.mesh = moved;
  model.size = box.sizes().maxCoeff();
  return model;
}

/// The mesh with the most triangles among the links of a robot.
std::optional<Model> largestLink(const RealRobot& robot)
{
  if (!robot.available())
    return std::nullopt;
  const std::shared_ptr<const RobotModel> model = robot.load();
  std::shared_ptr<const Mesh> largest;
  std::string name;
  for (const Link& link : model->links())
    for (const PlacedShape& shape : link.shapes)
    {
      const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape.shape);
      if (mesh == nullptr || (largest && (*mesh)->triangles.size() <= largest->triangles.size()))
        continue;
      largest = *mesh;
      name = robot.name + "_" + link.name;
    }
  if (!largest)
    return std::nullopt;
  Model made = centred(name, *largest);
  made.open = true;  // the meshes of robots have cracks
  return made;
}
}  // namespace

std::shared_ptr<const Mesh> lump(std::size_t triangles)
{
  return closedSurface(
      "lump", triangles, 2.0,
      [](double along, double angle) -> Vector3d
      {
        const Vector3d direction = onSphere(along, angle);
        const double humps = 0.8 + 0.2 * std::sin(5.0 * direction.x()) * std::cos(4.0 * direction.y() + 1.0) +
                             0.05 * std::sin(17.0 * direction.z()) * std::sin(13.0 * direction.x());
        return kRadius * humps * direction;
      });
}

const std::vector<std::string>& madeModelNames()
{
  static const std::vector<std::string> names = {"torus", "sphere", "lump", "car", "pipes"};
  return names;
}

Model madeModel(const std::string& name, std::size_t triangles, std::uint64_t seed)
{
  if (name == "torus")
  {
    Mesh mesh;
    add(*torus(triangles, kTorusTube / kRadius), Vector3d::Constant(kRadius), Eigen::Isometry3d::Identity(), mesh);
    return centred(name, mesh);
  }
  if (name == "sphere")
  {
    Model model = centred(
        name, *closedSurface(name, triangles, 2.0,
                             [](double along, double angle) -> Vector3d { return kRadius * onSphere(along, angle); }));
    model.convex = true;
    return model;
  }
  if (name == "lump")
    return centred(name, *lump(triangles));
  if (name == "car")
    return centred(name, *car(triangles, seed));
  if (name == "pipes")
    return centred(name, *pipes(triangles, seed));
  throw Error("there is no model '" + name + "'; use one of " + nameList(madeModelNames()));
}

std::vector<Model> fixedModels()
{
  std::vector<Model> models = {centred("box", *tessellate(Box{{1.0, 0.7, 0.4}}).mesh)};
  models.front().convex = true;
  for (const RealRobot& robot : {kr5(), ur5Robotiq(), drchubo()})
    if (std::optional<Model> link = largestLink(robot))
      models.push_back(std::move(*link));
  return models;
}
}  // namespace gpu_planning_scene::core::literature
