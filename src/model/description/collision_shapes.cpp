#include "model/description/collision_shapes.h"

#include <urdf_model/link.h>

#include "gpu_planning_scene/error.h"

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
  }
  throw Error("a collision element has an unknown geometry type");
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
                                         const RobotModelOptions& options, MeshCache& meshes)
{
  std::vector<PlacedShape> shapes;
  for (const urdf::CollisionSharedPtr& collision : link.collision_array)
  {
    const std::string element = where + ": link '" + link.name + "'";
    try
    {
      shapes.push_back(
          {toShape(*collision->geometry, options, meshes), toIsometry(collision->origin, "its <collision>")});
    }
    catch (const Error& error)
    {
      throw Error(element + ": " + error.what());
    }
    validateShape(shapes.back().shape, element);
  }
  return shapes;
}
}  // namespace gpu_planning_scene::core
