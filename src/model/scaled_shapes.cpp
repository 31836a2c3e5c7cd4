#include "model/scaled_shapes.h"

#include <algorithm>
#include <cmath>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
namespace
{
struct ScalePrimitive
{
  double factor;

  Shape operator()(const Box& box) const { return Box{box.size * factor}; }
  Shape operator()(const Sphere& sphere) const { return Sphere{sphere.radius * factor}; }
  Shape operator()(const Cylinder& cylinder) const
  {
    return Cylinder{cylinder.radius * factor, cylinder.length * factor};
  }
  Shape operator()(const Cone& cone) const { return Cone{cone.radius * factor, cone.length * factor}; }
  Shape operator()(const HalfSpace&) const { throw Error("a half-space cannot be scaled"); }
  Shape operator()(const std::shared_ptr<const Mesh>& mesh) const { return mesh; }
};

/// Whether a shape equals another one of the same kind.
struct EqualsShape
{
  const Shape& other;

  bool operator()(const Box& box) const { return box.size == std::get<Box>(other).size; }
  bool operator()(const Sphere& sphere) const { return sphere.radius == std::get<Sphere>(other).radius; }
  bool operator()(const Cylinder& cylinder) const
  {
    const auto& second = std::get<Cylinder>(other);
    return cylinder.radius == second.radius && cylinder.length == second.length;
  }
  bool operator()(const Cone& cone) const
  {
    const auto& second = std::get<Cone>(other);
    return cone.radius == second.radius && cone.length == second.length;
  }
  bool operator()(const HalfSpace& half_space) const
  {
    const auto& second = std::get<HalfSpace>(other);
    return half_space.normal == second.normal && half_space.offset == second.offset;
  }
  bool operator()(const std::shared_ptr<const Mesh>& mesh) const
  {
    const auto& second = std::get<std::shared_ptr<const Mesh>>(other);
    return mesh && second && mesh->vertices == second->vertices && mesh->triangles == second->triangles &&
           mesh->solid == second->solid;
  }
};
}  // namespace

std::shared_ptr<const Mesh> ShapeScaler::scaledMesh(const std::shared_ptr<const Mesh>& mesh, double factor)
{
  std::shared_ptr<const Mesh>& known = meshes_[{mesh.get(), factor}];
  if (known)
    return known;
  auto scaled = std::make_shared<Mesh>(*mesh);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : mesh->vertices)
    mean += vertex / static_cast<double>(mesh->vertices.size());
  for (Eigen::Vector3d& vertex : scaled->vertices)
    vertex = mean + factor * (vertex - mean);
  known = std::move(scaled);
  return known;
}

std::vector<PlacedShape> ShapeScaler::scaled(const std::vector<PlacedShape>& shapes, double factor)
{
  std::vector<PlacedShape> result = shapes;
  for (PlacedShape& placed : result)
  {
    if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape))
      placed.shape = scaledMesh(*mesh, factor);
    else
      placed.shape = std::visit(ScalePrimitive{factor}, placed.shape);
    validateShape(placed.shape, "scaled by " + std::to_string(factor));
  }
  return result;
}

bool isScaled(const std::vector<PlacedShape>& scaled, const std::vector<PlacedShape>& shapes, double factor)
{
  const std::vector<PlacedShape> right = ShapeScaler().scaled(shapes, factor);
  return std::equal(scaled.begin(), scaled.end(), right.begin(), right.end(),
                    [](const PlacedShape& a, const PlacedShape& b)
                    {
                      return a.pose.matrix() == b.pose.matrix() && a.shape.index() == b.shape.index() &&
                             std::visit(EqualsShape{b.shape}, a.shape);
                    });
}

std::shared_ptr<const RobotModel> RobotModel::scaled(const std::vector<double>& factors) const
{
  std::shared_ptr<const RobotModel> loaded = as_loaded_ ? as_loaded_ : shared_from_this();
  if (!factors.empty() && factors.size() != links_.size())
    throw Error("link_scale has " + std::to_string(factors.size()) + " values for " + std::to_string(links_.size()) +
                " links; give one per link, or none");
  for (std::size_t i = 0; i < factors.size(); ++i)
    if (!std::isfinite(factors[i]) || factors[i] <= 0.0)
      throw Error("link '" + links_[i].name + "': the scale is " + std::to_string(factors[i]) +
                  "; it must be finite and above 0");
  if (std::all_of(factors.begin(), factors.end(), [](double factor) { return factor == 1.0; }))
    return loaded;
  if (factors == link_scale_)
    return shared_from_this();

  const auto result = std::make_shared<RobotModel>(*loaded);
  result->as_loaded_ = loaded;
  result->link_scale_ = factors;
  ShapeScaler scaler;
  for (std::size_t i = 0; i < factors.size(); ++i)
  {
    Link& link = result->links_[i];
    try
    {
      if (factors[i] != 1.0)
        link.shapes = scaler.scaled(link.shapes, factors[i]);
    }
    catch (const Error& error)
    {
      throw Error("link '" + link.name + "': " + error.what());
    }
  }
  return result;
}
}  // namespace gpu_planning_scene::core
