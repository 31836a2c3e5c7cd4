#include "node/markers.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "collision/exact/binned_sah.h"
#include "gpu_planning_scene/error.h"
#include "render/drawing.h"
#include "render/renderer.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;

constexpr BodyColor kTreeColor{31, 119, 180, 255};

std_msgs::ColorRGBA toMessage(const BodyColor& color)
{
  std_msgs::ColorRGBA message;
  message.r = static_cast<float>(color[0]) / 255.0F;
  message.g = static_cast<float>(color[1]) / 255.0F;
  message.b = static_cast<float>(color[2]) / 255.0F;
  message.a = static_cast<float>(color[3]) / 255.0F;
  return message;
}

geometry_msgs::Point toPoint(const Eigen::Vector3d& vector)
{
  geometry_msgs::Point point;
  point.x = vector.x();
  point.y = vector.y();
  point.z = vector.z();
  return point;
}

geometry_msgs::Pose toPose(const Eigen::Isometry3d& pose)
{
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::Pose message;
  message.position = toPoint(pose.translation());
  message.orientation.x = rotation.x();
  message.orientation.y = rotation.y();
  message.orientation.z = rotation.z();
  message.orientation.w = rotation.w();
  return message;
}

/// The number of triangles that draw a shape; 0 if RViz has a marker for the shape.
std::size_t trianglesOf(const Shape& shape)
{
  if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape))
    return (*mesh)->triangles.size();
  return std::holds_alternative<Cone>(shape) ? tessellate(shape).mesh->triangles.size() : 0;
}

/// Triangle count of the largest shape that is drawn with its triangles: the smallest shapes together may have
/// `max_triangles`.
std::size_t largestDrawn(const PlanningScene& scene, std::size_t bodies, std::size_t max_triangles)
{
  std::vector<std::size_t> counts;
  for (std::size_t body = 0; body < bodies; ++body)
    for (const PlacedShape& shape : bodyShapes(scene, body))
      if (const std::size_t count = trianglesOf(shape.shape); count != 0)
        counts.push_back(count);
  std::sort(counts.begin(), counts.end());
  std::size_t sum = 0;
  std::size_t largest = 0;
  for (const std::size_t count : counts)
  {
    sum += count;
    if (sum > max_triangles)
      break;
    largest = count;
  }
  return largest;
}

/// The 24 points of a box's edges count as so many triangles.
constexpr std::size_t kTrianglesOfBox = 8;

class MarkerMaker
{
 public:
  MarkerMaker(const PlanningScene& scene, const double* state, const MarkerOptions& options)
    : scene_(scene), options_(options), poses_(bodyPoses(scene, state)), near_(nearRobot(scene, state))
  {
    Marker erase;
    erase.header = header();
    erase.action = Marker::DELETEALL;
    array_.markers.push_back(erase);
  }

  void addBodies(const std::set<std::size_t>& colliding)
  {
    largest_drawn_ = largestDrawn(scene_, poses_.size(), options_.max_triangles);
    for (std::size_t body = 0; body < poses_.size(); ++body)
    {
      lists_.clear();
      color_ = colliding.count(body) != 0 ? kCollidingColor : bodyColor(scene_, body);
      name_ = namespaceOf(body);
      for (const PlacedShape& shape : bodyShapes(scene_, body))
        addShape(shape.shape, poses_[body] * shape.pose);
    }
  }

  void addContacts(const std::vector<Eigen::Vector3d>& points)
  {
    if (points.empty())
      return;
    name_ = "contacts";
    color_ = kContactColor;
    Marker& marker = add(Marker::SPHERE_LIST, Eigen::Isometry3d::Identity());
    setScale(marker, Eigen::Vector3d::Constant(0.02 * near_.diagonal().norm()));
    for (const Eigen::Vector3d& point : points)
      marker.points.push_back(toPoint(point));
  }

  void addTreeLevel()
  {
    name_ = "tree";
    color_ = kTreeColor;
    for (std::size_t body = 0; body < poses_.size(); ++body)
      if (options_.tree_body.empty() || options_.tree_body == scene_.bodyName(static_cast<int>(body)))
        for (const PlacedShape& shape : bodyShapes(scene_, body))
          if (!std::holds_alternative<HalfSpace>(shape.shape))
            addTreeLevel(shape.shape, poses_[body] * shape.pose);
  }

  visualization_msgs::MarkerArray take() { return std::move(array_); }

 private:
  std_msgs::Header header() const
  {
    std_msgs::Header result;
    result.frame_id = scene_.robot->planningFrame();
    result.stamp = options_.stamp;
    return result;
  }

  std::string namespaceOf(std::size_t body) const
  {
    const std::size_t links = scene_.robot->links().size();
    return body < links ? "robot" : body < links + scene_.objects.size() ? "objects" : "attached";
  }

  Marker& add(int type, const Eigen::Isometry3d& pose)
  {
    Marker marker;
    marker.header = header();
    marker.ns = name_;
    marker.id = next_id_[name_]++;
    marker.type = type;
    marker.action = Marker::ADD;
    marker.pose = toPose(pose);
    setScale(marker, Eigen::Vector3d::Ones());
    marker.color = toMessage(color_);
    array_.markers.push_back(marker);
    return array_.markers.back();
  }

  static void setScale(Marker& marker, const Eigen::Vector3d& scale)
  {
    marker.scale.x = scale.x();
    marker.scale.y = scale.y();
    marker.scale.z = scale.z();
  }

  void addShape(const Shape& shape, const Eigen::Isometry3d& pose)
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
      addMesh(**mesh, pose);
    else
      addMesh(*tessellate(shape).mesh, pose);
  }

  /// Solids of equal size and rotation share a marker, because a point cloud has tens of thousands of cubes.
  void addToList(int type, const Eigen::Vector3d& size, const Eigen::Isometry3d& pose)
  {
    std::array<double, 13> key{static_cast<double>(type)};
    std::copy_n(size.data(), 3, key.begin() + 1);
    std::copy_n(pose.linear().data(), 9, key.begin() + 4);
    const Eigen::Isometry3d turned(pose.linear());
    const auto [place, is_new] = lists_.emplace(key, array_.markers.size());
    if (is_new)
      setScale(add(type, turned), size);
    array_.markers[place->second].points.push_back(toPoint(turned.inverse() * pose.translation()));
  }

  void addMesh(const Mesh& mesh, const Eigen::Isometry3d& pose)
  {
    const std::size_t count = mesh.triangles.size();
    if (count <= largest_drawn_ && drawn_ + count <= options_.max_triangles)
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

  void addTriangles(const Mesh& mesh, const Eigen::Isometry3d& pose)
  {
    Marker& marker = add(Marker::TRIANGLE_LIST, pose);
    marker.points.reserve(3 * mesh.triangles.size());
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t corner : triangle)
        marker.points.push_back(toPoint(mesh.vertices[corner]));
  }

  /// Draws a half-space as a thin plate below its plane. The plate is as large as the surroundings of the robot.
  void addPlane(const HalfSpace& plane, const Eigen::Isometry3d& pose)
  {
    constexpr double kThickness = 0.002;
    const double size = near_.diagonal().norm();
    const Eigen::Vector3d normal = pose.linear() * plane.normal;
    const double height = normal.dot(near_.center() - pose.translation()) - plane.offset;
    Eigen::Isometry3d plate = Eigen::Isometry3d::Identity();
    plate.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
    plate.translation() = near_.center() - (height + 0.5 * kThickness) * normal;
    setScale(add(Marker::CUBE, plate), {size, size, kThickness});
  }

  void addTreeLevel(const Shape& shape, const Eigen::Isometry3d& pose)
  {
    const Forest forest = buildBinnedSah(std::vector<Tessellation>{tessellate(shape)});
    std::vector<std::uint32_t> level{forest.roots[0]};
    for (int depth = 0; depth < options_.tree_level; ++depth)
    {
      std::vector<std::uint32_t> below;
      for (const std::uint32_t node : level)
        if (forest.nodes[node].count != 0)
          below.push_back(node);  // leaves are kept, so that every level covers the shape
        else
          below.insert(below.end(), {forest.nodes[node].first, forest.nodes[node].first + 1});
      if (below == level || drawn_ + kTrianglesOfBox * below.size() > options_.max_triangles)
        break;
      level = std::move(below);
    }
    drawn_ += kTrianglesOfBox * level.size();
    Marker& marker = add(Marker::LINE_LIST, pose);
    marker.scale.x = 0.001 * near_.diagonal().norm();
    for (const std::uint32_t node : level)
      addEdges(forest.nodes[node], marker);
  }

  static void addEdges(const Node& node, Marker& marker)
  {
    const auto corner = [&](int bits)
    {
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis)
        point[axis] =
            static_cast<double>(node.center[axis]) + (((bits >> axis) & 1) != 0 ? 1.0 : -1.0) * node.half[axis];
      return toPoint(point);
    };
    for (int bits = 0; bits < 8; ++bits)
      for (int axis = 0; axis < 3; ++axis)
        if (((bits >> axis) & 1) == 0)
          marker.points.insert(marker.points.end(), {corner(bits), corner(bits | (1 << axis))});
  }

  const PlanningScene& scene_;
  const MarkerOptions& options_;
  const std::vector<Eigen::Isometry3d> poses_;
  const Eigen::AlignedBox3d near_;
  visualization_msgs::MarkerArray array_;
  std::size_t largest_drawn_ = 0;  // shapes with more triangles are drawn as boxes
  std::size_t drawn_ = 0;          // triangles so far; tree boxes count as kTrianglesOfBox
  std::map<std::string, int> next_id_;
  std::map<std::array<double, 13>, std::size_t> lists_;  // list markers of the body, by type, size and rotation
  std::string name_;
  BodyColor color_{};
};

bool hasBody(const PlanningScene& scene, const std::string& name)
{
  const std::size_t bodies = scene.robot->links().size() + scene.objects.size() + scene.attached.size();
  for (std::size_t i = 0; i < bodies; ++i)
    if (scene.bodyName(static_cast<int>(i)) == name)
      return true;
  return false;
}
}  // namespace

void requireTreeLevel(const PlanningScene& scene, int level, const std::string& body)
{
  if (level < -1)
    throw Error("there is no level " + std::to_string(level) + "; give 0 for the roots, -1 for no boxes");
  if (!body.empty() && !hasBody(scene, body))
    throw Error("the scene has no link or object '" + body + "'");
}

visualization_msgs::MarkerArray markersOf(const PlanningScene& scene, const double* state,
                                          const std::vector<BodyPair>& colliding,
                                          const std::vector<Eigen::Vector3d>& contact_points,
                                          const MarkerOptions& options)
{
  MarkerMaker maker(scene, state, options);
  maker.addBodies(bodiesOf(colliding));
  maker.addContacts(contact_points);
  if (options.tree_level >= 0)
    maker.addTreeLevel();
  return maker.take();
}
}  // namespace gpu_planning_scene::core
