#include "gpu_planning_scene/shapes.h"

#include <cmath>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
void requirePositive(double value, const char* dimension, const std::string& where)
{
  if (!(value > 0.0) || value > kLargestLength)
  {
    throw Error(where + ": the " + dimension + " is " + numberText(value) +
                ", it must be positive and at most 1000 km");
  }
}

struct DimensionCheck
{
  const std::string& where;

  void operator()(const Box& box) const
  {
    requirePositive(box.size.x(), "size along x", where);
    requirePositive(box.size.y(), "size along y", where);
    requirePositive(box.size.z(), "size along z", where);
  }
  void operator()(const Sphere& sphere) const { requirePositive(sphere.radius, "radius", where); }
  void operator()(const Cylinder& cylinder) const
  {
    requirePositive(cylinder.radius, "radius", where);
    requirePositive(cylinder.length, "length", where);
  }
  void operator()(const Cone& cone) const
  {
    requirePositive(cone.radius, "radius", where);
    requirePositive(cone.length, "length", where);
  }
  void operator()(const HalfSpace& half_space) const
  {
    if (!(std::abs(half_space.offset) <= kLargestLength) || !(std::abs(half_space.normal.norm() - 1.0) <= 1e-12))
      throw Error(where + ": a half-space's offset must be at most 1000 km and its normal of unit length");
  }
  void operator()(const std::shared_ptr<const Mesh>& mesh) const
  {
    if (!mesh)
      throw Error(where + ": the mesh is missing");
    try
    {
      validateMesh(*mesh);
    }
    catch (const Error& error)
    {
      throw Error(where + ": " + error.what());
    }
  }
};
}  // namespace

void validateMesh(const Mesh& mesh)
{
  const std::string name = "mesh '" + mesh.name + "'";
  if (mesh.triangles.empty())
    throw Error(name + " has no triangles");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
  {
    // In this form, NaN fails too.
    if (!(mesh.vertices[i].array().abs() <= kLargestLength).all())
      throw Error(name + ": vertex " + std::to_string(i) + " is not finite or farther than 1000 km away");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
  {
    for (const std::uint32_t vertex : mesh.triangles[i])
    {
      if (vertex >= mesh.vertices.size())
      {
        throw Error(name + ": triangle " + std::to_string(i) + " names vertex " + std::to_string(vertex) +
                    ", but there are " + std::to_string(mesh.vertices.size()) + " vertices");
      }
    }
  }
}

void validateShape(const Shape& shape, const std::string& where)
{
  std::visit(DimensionCheck{where}, shape);
}
}  // namespace gpu_planning_scene::core
