#include "moveit/shapes/collision_shape.h"

#include <cstddef>
#include <utility>

#include <octomap/OcTree.h>

#include "collision/contacts/contact_shape.h"
#include "gpu_planning_scene/error.h"
#include "model/zero_size.h"
#include "scene/message_values.h"

// Converts MoveIt's shapes. Primitives are tested as solids, so they need no triangles.
namespace gpu_planning_scene::detector
{
namespace
{
using Eigen::Vector3d;

std::shared_ptr<const core::Mesh> meshOf(const shapes::Mesh& mesh, double scale, const std::string& name)
{
  auto made = std::make_shared<core::Mesh>();
  made->name = name;
  made->vertices.reserve(mesh.vertex_count);
  for (std::size_t i = 0; i < mesh.vertex_count; ++i)
    made->vertices.emplace_back(mesh.vertices[3 * i], mesh.vertices[3 * i + 1], mesh.vertices[3 * i + 2]);
  made->triangles.reserve(mesh.triangle_count);
  for (std::size_t i = 0; i < mesh.triangle_count; ++i)
    made->triangles.push_back({mesh.triangles[3 * i], mesh.triangles[3 * i + 1], mesh.triangles[3 * i + 2]});
  if (scale != 1.0)
  {
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& vertex : made->vertices)
      mean += vertex / static_cast<double>(made->vertices.size());
    for (Vector3d& vertex : made->vertices)
      vertex = mean + scale * (vertex - mean);
  }
  return made;
}
}  // namespace

CollisionShape::CollisionShape(const shapes::Shape& shape, double scale, const std::string& name)
{
  try
  {
    convert(shape, scale, name);
  }
  catch (const std::exception& error)  // memory can run out too
  {
    kind_ = ShapeKind::Faulty;
    fault_ = error.what();
  }
}

CollisionShape::CollisionShape(double side)
{
  setSolid(core::Box{Vector3d::Constant(side)});
}

const CollisionShape& CollisionShape::faulty()
{
  static const CollisionShape shape;
  return shape;
}

void CollisionShape::setSolid(core::Shape shape)
{
  if (core::thicken(shape) == core::ZeroSize::Point)
  {
    kind_ = ShapeKind::Empty;
    return;
  }
  core::validateShape(shape, "shape");
  const bool mesh = std::holds_alternative<std::shared_ptr<const core::Mesh>>(shape);
  tree_ = mesh ? core::cpuTreeOf(shape, core::tessellate(shape)) : core::makeSolidTree(shape);
  kind_ = ShapeKind::Solid;
}

void CollisionShape::convert(const shapes::Shape& shape, double scale, const std::string& name)
{
  switch (shape.type)
  {
    case shapes::BOX:
      return setSolid(core::Box{scale * Vector3d(static_cast<const shapes::Box&>(shape).size)});
    case shapes::SPHERE:
      return setSolid(core::Sphere{scale * static_cast<const shapes::Sphere&>(shape).radius});
    case shapes::CYLINDER:
    {
      const auto& cylinder = static_cast<const shapes::Cylinder&>(shape);
      return setSolid(core::Cylinder{scale * cylinder.radius, scale * cylinder.length});
    }
    case shapes::CONE:
    {
      const auto& cone = static_cast<const shapes::Cone&>(shape);
      return setSolid(core::Cone{scale * cone.radius, scale * cone.length});
    }
    case shapes::MESH:
    {
      const auto& mesh = static_cast<const shapes::Mesh&>(shape);
      if (mesh.triangle_count > 0)
        return setSolid(meshOf(mesh, scale, name));
      kind_ = ShapeKind::Empty;
      return;
    }
    case shapes::PLANE:
    {
      const auto& plane = static_cast<const shapes::Plane&>(shape);
      half_space_ = core::halfSpaceBehind({plane.a, plane.b, plane.c, plane.d});
      core::validateShape(half_space_, "plane");
      kind_ = ShapeKind::HalfSpace;
      return;
    }
    case shapes::OCTREE:
    {
      octree_ = static_cast<const shapes::OcTree&>(shape).octree;
      if (!octree_)
        throw core::Error("the octree is missing");
      for (unsigned depth = 0; depth <= octree_->getTreeDepth(); ++depth)
        leaves_.push_back(std::make_shared<const CollisionShape>(octree_->getNodeSize(static_cast<int>(depth))));
      leaf_resolution_ = octree_->getResolution();
      kind_ = ShapeKind::Octree;
      return;
    }
    default:
      throw core::Error("shapes of type " + std::to_string(static_cast<int>(shape.type)) + " are not supported");
  }
}

std::shared_ptr<const CollisionShape> CollisionShape::leaf(unsigned depth) const
{
  if (octree_->getResolution() == leaf_resolution_ && depth < leaves_.size())
    return leaves_[depth];
  return std::make_shared<const CollisionShape>(octree_->getNodeSize(static_cast<int>(depth)));
}

bool CollisionShape::isConvex() const
{
  std::call_once(convexity_known_, [this] { is_convex_ = core::isConvexSolid(*tree_); });
  return is_convex_;
}
}  // namespace gpu_planning_scene::detector
