#include "model/description/collision_shapes.h"

#include <urdf_model/link.h>

#include "gpu_planning_scene/error.h"
#include "model/zero_size.h"

namespace gpu_planning_scene::core
{
namespace
{
Shape toShape(const urdf::Geometry& geometry, const RobotModelOptions& options, MeshCache& meshes)
{
  switch (geometry.type)
  {
    case urdf::Geometry::BOX:
    {
      const auto& size = static_cast<const urdf::Box&>(geometry).dim;
      return Box{{size.x, size.y, size.z}};
    }
    case urdf::Geometry::SPHERE:
      return Sphere{static_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::CYLINDER:
    {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      return Cylinder{cylinder.radius, cylinder.length};
    }
    case urdf::Geometry::MESH:
    {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      return meshes.load(options.meshes.resolve(mesh.filename, options.urdf_folder, options.packages),
                         {mesh.scale.x, mesh.scale.y, mesh.scale.z});
    }
    default:  // the capsule of urdfdom 5, which urdf_names.cpp refuses with the line of the file
      break;
  }
  throw Error("a collision element has an unknown geometry type");
}

/// The name of a shape's element in the URDF.
const char* nameOf(const urdf::Geometry& geometry)
{
  switch (geometry.type)
  {
    case urdf::Geometry::BOX:
      return "box";
    case urdf::Geometry::SPHERE:
      return "sphere";
    case urdf::Geometry::CYLINDER:
      return "cylinder";
    default:
      return "mesh";
  }
}

bool isMeshOfSizeZero(const urdf::Geometry& geometry)
{
  if (geometry.type != urdf::Geometry::MESH)
    return false;
  const urdf::Vector3& scale = static_cast<const urdf::Mesh&>(geometry).scale;
  return scale.x == 0.0 && scale.y == 0.0 && scale.z == 0.0;
}
}  // namespace

Eigen::Isometry3d toIsometry(const urdf::Pose& pose, const std::string& where)
{
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const urdf::Rotation& q = pose.rotation;
  result.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  if (!(result.translation().cwiseAbs().maxCoeff() <= kLargestLength))
    throw Error(where + " has an origin that is not finite, or more than 1000 km away");
  return result;
}

std::vector<PlacedShape> collisionShapes(const urdf::Link& link, const std::string& where,
                                         const RobotModelOptions& options, MeshCache& meshes,
                                         std::vector<std::string>& warnings)
{
  std::vector<PlacedShape> shapes;
  for (const urdf::CollisionSharedPtr& collision : link.collision_array)
  {
    const std::string element = where + ": link '" + link.name + "'";
    const std::string shape = element + ": a <" + nameOf(*collision->geometry) + ">";
    ZeroSize size = isMeshOfSizeZero(*collision->geometry) ? ZeroSize::Point : ZeroSize::None;
    if (size == ZeroSize::None)
    {
      try
      {
        shapes.push_back(
            {toShape(*collision->geometry, options, meshes), toIsometry(collision->origin, "its <collision>")});
      }
      catch (const Error& error)
      {
        throw Error(element + ": " + error.what());
      }
      size = thicken(shapes.back().shape);
      if (size == ZeroSize::Point)
        shapes.pop_back();
      else
        validateShape(shapes.back().shape, element);
    }
    if (size == ZeroSize::Point)
      warnings.push_back(shape + " of size 0 is left out, because it is a point");
    else if (size == ZeroSize::Flat)
      warnings.push_back(shape + " has a size of 0, so it is flat or a line; it is checked with 1e-9 m instead");
  }
  return shapes;
}
}  // namespace gpu_planning_scene::core
