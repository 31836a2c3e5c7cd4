#include "node/markers/shape_markers.h"

#include <algorithm>
#include <variant>

#include "node/messages/pose_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;

std_msgs::ColorRGBA toMessage(const BodyColor& color)
{
  std_msgs::ColorRGBA message;
  message.r = static_cast<float>(color[0]) / 255.0F;
  message.g = static_cast<float>(color[1]) / 255.0F;
  message.b = static_cast<float>(color[2]) / 255.0F;
  message.a = static_cast<float>(color[3]) / 255.0F;
  return message;
}
}  // namespace

void setScale(Marker& marker, const Eigen::Vector3d& scale)
{
  marker.scale.x = scale.x();
  marker.scale.y = scale.y();
  marker.scale.z = scale.z();
}

std::size_t trianglesOf(const Shape& shape)
{
  if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape))
    return (*mesh)->triangles.size();
  return std::holds_alternative<Cone>(shape) ? tessellate(shape).mesh->triangles.size() : 0;
}

void ShapeMarkers::limitTriangles(std::size_t max_triangles, std::vector<std::size_t> shapes)
{
  max_triangles_ = max_triangles;
  largest_drawn_ = 0;
  std::sort(shapes.begin(), shapes.end());
  std::size_t sum = 0;
  for (const std::size_t count : shapes)
  {
    sum += count;
    if (sum > max_triangles)
      break;
    largest_drawn_ = count;
  }
}

void ShapeMarkers::begin(const std::string& name, const BodyColor& color, const BodyColor& open)
{
  lists_.clear();
  name_ = name;
  color_ = color;
  open_color_ = open;
}

Marker& ShapeMarkers::add(int type, const Eigen::Isometry3d& pose)
{
  Marker marker;
  marker.header = header_;
  marker.ns = name_;
  marker.id = next_id_[name_]++;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose = poseOf(pose);
  setScale(marker, Eigen::Vector3d::Ones());
  marker.color = toMessage(color_);
  array_.markers.push_back(marker);
  return array_.markers.back();
}

void ShapeMarkers::addShape(const Shape& shape, const Eigen::Isometry3d& pose)
{
  if (const auto* box = std::get_if<Box>(&shape))
    addToList(Marker::CUBE_LIST, box->size, pose);
  else if (const auto* sphere = std::get_if<Sphere>(&shape))
    addToList(Marker::SPHERE_LIST, Eigen::Vector3d::Constant(2.0 * sphere->radius), pose);
  else if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    setScale(add(Marker::CYLINDER, pose), {2.0 * cylinder->radius, 2.0 * cylinder->radius, cylinder->length});
  else if (const auto* plane = std::get_if<HalfSpace>(&shape))
    addPlane(*plane, pose);
  else if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape))
  {
    const std::shared_ptr<const SolidMesh> solid = solidMeshOf(*mesh);
    addMesh(*solid->mesh, pose);
    colorOpenTriangles(*solid);
  }
  else
    addMesh(*tessellate(shape).mesh, pose);
}

/// Solids of equal size and rotation share a marker, because a point cloud has tens of thousands of cubes.
void ShapeMarkers::addToList(int type, const Eigen::Vector3d& size, const Eigen::Isometry3d& pose)
{
  std::array<double, 13> key{static_cast<double>(type)};
  std::copy_n(size.data(), 3, key.begin() + 1);
  std::copy_n(pose.linear().data(), 9, key.begin() + 4);
  const Eigen::Isometry3d turned(pose.linear());
  const auto [place, is_new] = lists_.emplace(key, array_.markers.size());
  if (is_new)
    setScale(add(type, turned), size);
  array_.markers[place->second].points.push_back(pointOf(turned.inverse() * pose.translation()));
}

void ShapeMarkers::addMesh(const Mesh& mesh, const Eigen::Isometry3d& pose)
{
  const std::size_t count = mesh.triangles.size();
  if (count <= largest_drawn_ && drawn_ + count <= max_triangles_)
  {
    drawn_ += count;
    addTriangles(mesh, pose);
    return;
  }
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  setScale(add(Marker::CUBE, pose * Eigen::Translation3d(box.center())), box.sizes().cwiseMax(1e-3));
}

void ShapeMarkers::addTriangles(const Mesh& mesh, const Eigen::Isometry3d& pose)
{
  Marker& marker = add(Marker::TRIANGLE_LIST, pose);
  marker.points.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      marker.points.push_back(pointOf(mesh.vertices[corner]));
}

/// Gives the triangles of the last marker that bound no solid another colour.
void ShapeMarkers::colorOpenTriangles(const SolidMesh& solid)
{
  Marker& marker = array_.markers.back();
  if (marker.type != Marker::TRIANGLE_LIST || solid.parts.count(PartKind::Surface) == 0 || open_color_ == color_)
    return;
  const std_msgs::ColorRGBA open = toMessage(open_color_);
  for (std::size_t i = 0; i < solid.mesh->triangles.size(); ++i)
    marker.colors.insert(marker.colors.end(), 3, solid.isOpen(i) ? open : marker.color);
}

/// Draws a half-space as a thin plate below its plane. The plate is as large as the surroundings.
void ShapeMarkers::addPlane(const HalfSpace& plane, const Eigen::Isometry3d& pose)
{
  constexpr double kThickness = 0.002;
  const double size = surroundings_.diagonal().norm();
  const Eigen::Vector3d normal = pose.linear() * plane.normal;
  const double height = normal.dot(surroundings_.center() - pose.translation()) - plane.offset;
  Eigen::Isometry3d plate = Eigen::Isometry3d::Identity();
  plate.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
  plate.translation() = surroundings_.center() - (height + 0.5 * kThickness) * normal;
  setScale(add(Marker::CUBE, plate), {size, size, kThickness});
}
}  // namespace gpu_planning_scene::core
