#include "node/markers/scene_markers.h"

#include "collision/trees/binned_sah.h"
#include "gpu_planning_scene/error.h"
#include "node/markers/shape_markers.h"
#include "node/messages/pose_messages.h"
#include "render/renderer.h"
#include "scene/has_body.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;

constexpr BodyColor kTreeColor{31, 119, 180, 255};

/// The 24 points of a box's edges count as so many triangles.
constexpr std::size_t kTrianglesOfBox = 8;

/// Colliding objects are translucent, so that links and contact points inside of them are visible. Links are not: RViz
/// does not sort the triangles of a translucent body by depth, so it would look torn.
constexpr std::uint8_t kCollidingObjectOpacity = 110;

std::vector<std::size_t> triangleCounts(const PlanningScene& scene, std::size_t bodies)
{
  std::vector<std::size_t> counts;
  for (std::size_t body = 0; body < bodies; ++body)
    for (const PlacedShape& shape : bodyShapes(scene, body))
      counts.push_back(trianglesOf(shape.shape));
  return counts;
}

class MarkerMaker
{
 public:
  // The analyzer does not see that the counters of ShapeMarkers have initial values.
  // NOLINTNEXTLINE(clang-analyzer-optin.cplusplus.UninitializedObject)
  MarkerMaker(const PlanningScene& scene, const double* state, const MarkerOptions& options)
    : scene_(scene),
      options_(options),
      poses_(bodyPoses(scene, state)),
      near_(nearRobot(scene, state)),
      markers_(headerOf(scene, options), near_)
  {
  }

  void addBodies(const std::set<std::size_t>& colliding)
  {
    markers_.limitTriangles(options_.max_triangles, triangleCounts(scene_, poses_.size()));
    for (std::size_t body = 0; body < poses_.size(); ++body)
    {
      BodyColor color = bodyColor(scene_, body);
      BodyColor open = openColor(color);
      if (colliding.count(body) != 0)
      {
        color = collidingColor(scene_, body);
        if (namespaceOf(body) == "objects")
          color[3] = kCollidingObjectOpacity;
        open = color;
      }
      markers_.begin(namespaceOf(body), color, open);
      for (const PlacedShape& shape : bodyShapes(scene_, body))
        markers_.addShape(shape.shape, poses_[body] * shape.pose);
    }
    drawn_ = markers_.trianglesDrawn();
  }

  void addContacts(const std::vector<BodyPair>& colliding, const std::vector<Eigen::Vector3d>& points)
  {
    if (points.empty())
      return;
    markers_.begin("contacts", kContactColor);
    Marker& marker = markers_.add(Marker::SPHERE_LIST, Eigen::Isometry3d::Identity());
    setScale(marker, Eigen::Vector3d::Constant(contactDiameter(scene_, poses_, colliding, near_)));
    for (const Eigen::Vector3d& point : points)
      marker.points.push_back(pointOf(point));
  }

  void addTreeLevel()
  {
    markers_.begin("tree", kTreeColor);
    for (std::size_t body = 0; body < poses_.size(); ++body)
      if (options_.tree_body.empty() || options_.tree_body == scene_.bodyName(static_cast<int>(body)))
        for (const PlacedShape& shape : bodyShapes(scene_, body))
          if (!std::holds_alternative<HalfSpace>(shape.shape))
            addTreeLevel(shape.shape, poses_[body] * shape.pose);
  }

  visualization_msgs::MarkerArray take() { return markers_.take(); }

 private:
  static std_msgs::Header headerOf(const PlanningScene& scene, const MarkerOptions& options)
  {
    std_msgs::Header header;
    header.frame_id = scene.robot->planningFrame();
    header.stamp = options.stamp;
    return header;
  }

  std::string namespaceOf(std::size_t body) const
  {
    const std::size_t links = scene_.robot->links().size();
    return body < links ? "robot" : body < links + scene_.objects.size() ? "objects" : "attached";
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
    Marker& marker = markers_.add(Marker::LINE_LIST, pose);
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
      return pointOf(point);
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
  ShapeMarkers markers_;
  std::size_t drawn_ = 0;  // triangles so far; tree boxes count as kTrianglesOfBox
};
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
  maker.addContacts(colliding, contact_points);
  if (options.tree_level >= 0)
    maker.addTreeLevel();
  return maker.take();
}
}  // namespace gpu_planning_scene::core
