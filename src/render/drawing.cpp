#include "render/drawing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "gpu_planning_scene/solids.h"
#include "render/renderer.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr BodyColor kLink{186, 190, 196, 255};
constexpr BodyColor kCarried{120, 170, 120, 255};
constexpr BodyColor kOpen{150, 90, 170, 255};
constexpr BodyColor kFloor{226, 229, 234, 255};
constexpr std::array<BodyColor, 6> kObjects{{{222, 196, 150, 255},
                                             {150, 182, 214, 255},
                                             {178, 205, 160, 255},
                                             {205, 170, 190, 255},
                                             {170, 200, 200, 255},
                                             {214, 206, 170, 255}}};

class Painter
{
 public:
  explicit Painter(std::vector<DrawnVertex>& vertices) : vertices_(vertices) {}

  void addTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const BodyColor& color)
  {
    const Eigen::Vector3d normal = (b - a).cross(c - a).stableNormalized();
    for (const Eigen::Vector3d* corner : {&a, &b, &c})
    {
      const Eigen::Vector3f position = corner->cast<float>();
      const Eigen::Vector3f direction = normal.cast<float>();
      vertices_.push_back(
          {{{position.x(), position.y(), position.z()}}, {{direction.x(), direction.y(), direction.z()}}, color});
    }
  }

  /// `open`: the colour of triangles that bound no solid.
  void addMesh(const Tessellation& tessellation, const Eigen::Isometry3d& pose, const BodyColor& color,
               const BodyColor& open)
  {
    const Mesh& mesh = *tessellation.mesh;
    std::vector<Eigen::Vector3d> placed;
    placed.reserve(mesh.vertices.size());
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      placed.push_back(pose * vertex);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    {
      const auto& [a, b, c] = mesh.triangles[i];
      const bool is_open = tessellation.solid && tessellation.solid->isOpen(i);
      addTriangle(placed[a], placed[b], placed[c], is_open ? open : color);
    }
  }

  /// Adds the part of the half-space's plane around `center`: a square with edges of twice `half_size`.
  void addPlane(const HalfSpace& plane, const Eigen::Isometry3d& pose, const Eigen::Vector3d& center, double half_size,
                const BodyColor& color)
  {
    const Eigen::Vector3d normal = pose.linear() * plane.normal;
    const double height = normal.dot(center - pose.translation()) - plane.offset;
    const Eigen::Vector3d middle = center - height * normal;
    const Eigen::Vector3d along = normal.unitOrthogonal() * half_size;
    const Eigen::Vector3d across = normal.cross(along);
    addTriangle(middle - along - across, middle + along - across, middle + along + across, color);
    addTriangle(middle - along - across, middle + along + across, middle - along + across, color);
  }

 private:
  std::vector<DrawnVertex>& vertices_;
};

/// Tessellates equal solids only once: a point cloud has thousands of equal cubes.
class Tessellations
{
 public:
  Tessellation of(const Shape& shape)
  {
    if (std::holds_alternative<std::shared_ptr<const Mesh>>(shape))
      return tessellate(shape);
    std::array<double, 4> key{static_cast<double>(shape.index()), 0.0, 0.0, 0.0};
    if (const auto* box = std::get_if<Box>(&shape))
      std::copy_n(box->size.data(), 3, key.begin() + 1);
    else if (const auto* sphere = std::get_if<Sphere>(&shape))
      key[1] = sphere->radius;
    else if (const auto* cylinder = std::get_if<Cylinder>(&shape))
      key = {key[0], cylinder->radius, cylinder->length, 0.0};
    else if (const auto* cone = std::get_if<Cone>(&shape))
      key = {key[0], cone->radius, cone->length, 0.0};
    Tessellation& made = made_[key];
    if (!made.mesh)
      made = tessellate(shape);
    return made;
  }

 private:
  std::map<std::array<double, 4>, Tessellation> made_;
};

void addFloor(const Eigen::AlignedBox3d& near, const Eigen::Vector3d& up, Drawing& drawing, Painter& painter)
{
  double lowest = 0.0;
  for (int corner = 0; corner < 8; ++corner)
    lowest =
        std::min(lowest, up.dot(near.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - near.center()));
  const double size = near.diagonal().norm();
  // A little lower, so that the bottom of a body does not flicker.
  drawing.floor.center = near.center() + (lowest - 0.002 * size) * up;
  drawing.floor.radius = 1.6 * size;
  const HalfSpace plane{up, up.dot(drawing.floor.center)};
  painter.addPlane(plane, Eigen::Isometry3d::Identity(), drawing.floor.center, drawing.floor.radius, kFloor);
}

Eigen::AlignedBox3d shapeBounds(const Shape& shape, const Eigen::Isometry3d& pose)
{
  Eigen::Vector3d half;
  if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape))
  {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : (*mesh)->vertices)
      box.extend(pose * vertex);
    return box;
  }
  if (const auto* box = std::get_if<Box>(&shape))
    half = 0.5 * box->size;
  else if (const auto* sphere = std::get_if<Sphere>(&shape))
    half.setConstant(sphere->radius);
  else if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    half = Eigen::Vector3d(cylinder->radius, cylinder->radius, 0.5 * cylinder->length);
  else if (const auto* cone = std::get_if<Cone>(&shape))
    half = Eigen::Vector3d(cone->radius, cone->radius, 0.5 * cone->length);
  else
    return {};
  const Eigen::Vector3d extent = pose.linear().cwiseAbs() * half;
  return {pose.translation() - extent, pose.translation() + extent};
}
}  // namespace

const std::vector<PlacedShape>& bodyShapes(const PlanningScene& scene, std::size_t body)
{
  const std::size_t links = scene.robot->links().size();
  if (body < links)
    return scene.robot->links()[body].shapes;
  if (body < links + scene.objects.size())
    return scene.objects[body - links].shapes;
  return scene.attached[body - links - scene.objects.size()].shapes();
}

BodyColor collidingColor(const PlanningScene& scene, std::size_t body)
{
  const std::size_t links = scene.robot->links().size();
  return body >= links && body < links + scene.objects.size() ? kCollidingObjectColor : kCollidingColor;
}

BodyColor bodyColor(const PlanningScene& scene, std::size_t body)
{
  const auto chosen = scene.colors.find(scene.bodyName(static_cast<int>(body)));
  if (chosen != scene.colors.end())
  {
    const auto byte = [](float share)
    { return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F))); };
    const Color& color = chosen->second;
    return {byte(color.r), byte(color.g), byte(color.b), byte(color.a)};
  }
  const std::size_t links = scene.robot->links().size();
  if (body < links)
    return kLink;
  if (body < links + scene.objects.size())
    return kObjects[(body - links) % kObjects.size()];
  return kCarried;
}

BodyColor openColor(const BodyColor& color)
{
  BodyColor open = color;
  for (std::size_t i = 0; i < 3; ++i)
    open[i] = static_cast<std::uint8_t>((open[i] + 2 * kOpen[i]) / 3);
  return open;
}

std::set<std::size_t> bodiesOf(const std::vector<BodyPair>& pairs)
{
  std::set<std::size_t> bodies;
  for (const auto& pair : pairs)
    bodies.insert({static_cast<std::size_t>(pair[0]), static_cast<std::size_t>(pair[1])});
  return bodies;
}

std::vector<Eigen::Isometry3d> bodyPoses(const PlanningScene& scene, const double* state)
{
  std::vector<Eigen::Isometry3d> poses(scene.robot->links().size());
  scene.robot->linkPoses(state, poses.data());
  for (const WorldObject& object : scene.objects)
    poses.push_back(object.pose);
  for (const AttachedObject& attached : scene.attached)
    poses.push_back(poses[static_cast<std::size_t>(attached.link)] * attached.object.pose);
  return poses;
}

Eigen::AlignedBox3d bodyBounds(const PlanningScene& scene, int body, const Eigen::Isometry3d& pose)
{
  Eigen::AlignedBox3d bounds;
  for (const PlacedShape& shape : bodyShapes(scene, static_cast<std::size_t>(body)))
    bounds.extend(shapeBounds(shape.shape, pose * shape.pose));
  return bounds;
}

double contactDiameter(const PlanningScene& scene, const std::vector<Eigen::Isometry3d>& poses,
                       const std::vector<BodyPair>& colliding, const Eigen::AlignedBox3d& near)
{
  constexpr double kOfBody = 0.3;
  constexpr double kLeast = 0.006;  // of the picture
  constexpr double kMost = 0.014;
  const double size = near.diagonal().norm();
  double diameter = kMost * size;
  for (const std::size_t body : bodiesOf(colliding))
    if (const Eigen::AlignedBox3d bounds = bodyBounds(scene, static_cast<int>(body), poses[body]); !bounds.isEmpty())
      diameter = std::min(diameter, kOfBody * bounds.diagonal().norm());
  return std::max(diameter, kLeast * size);
}

Drawing drawingOf(const PlanningScene& scene, const double* state, const std::vector<BodyPair>& colliding,
                  const std::vector<Eigen::Vector3d>& contact_points, const Eigen::Vector3d& up)
{
  const std::set<std::size_t> red = bodiesOf(colliding);
  const Eigen::AlignedBox3d near = nearRobot(scene, state);
  Drawing drawing;
  Painter painter(drawing.vertices);
  Tessellations tessellations;
  const auto poses = bodyPoses(scene, state);
  const std::size_t links = scene.robot->links().size();
  bool has_plane = false;
  for (std::size_t body = 0; body < poses.size(); ++body)
  {
    const std::size_t begin = drawing.vertices.size();
    const bool is_red = red.count(body) != 0;
    const BodyColor color = is_red ? collidingColor(scene, body) : bodyColor(scene, body);
    const BodyColor open = is_red ? color : openColor(color);
    for (const PlacedShape& shape : bodyShapes(scene, body))
    {
      const Eigen::Isometry3d pose = poses[body] * shape.pose;
      if (const auto* plane = std::get_if<HalfSpace>(&shape.shape))
      {
        painter.addPlane(*plane, pose, near.center(), 0.5 * near.diagonal().norm(), color);
        has_plane = true;
      }
      else
        painter.addMesh(tessellations.of(shape.shape), pose, color, open);
    }
    const std::size_t end = drawing.vertices.size();
    const bool is_object = body >= links && body < links + scene.objects.size();
    if (begin != end && !is_object)
      drawing.robot.push_back({begin, end, is_red});
    if (body < links)
      drawing.links_end = end;
    if (body < links || is_object)
      drawing.objects_end = end;
  }
  drawing.bodies_end = drawing.vertices.size();
  const Shape dot = Sphere{0.5 * contactDiameter(scene, poses, colliding, near)};
  for (const Eigen::Vector3d& point : contact_points)
    painter.addMesh(tessellations.of(dot), Eigen::Isometry3d(Eigen::Translation3d(point)), kContactColor,
                    kContactColor);
  drawing.contacts_end = drawing.vertices.size();
  if (!has_plane)
    addFloor(near, up, drawing, painter);
  return drawing;
}
}  // namespace gpu_planning_scene::core
