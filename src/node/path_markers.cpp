#include "node/path_markers.h"

#include <algorithm>
#include <cmath>

#include "gpu_planning_scene/interpolation.h"
#include "node/shape_markers.h"
#include "render/renderer.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;

// A straight motion in joint space is a curve in the planning frame, so a line has several points per motion.
constexpr double kStep = 0.05;           // radians and metres between two points of a line
constexpr double kMaxSteps = 200.0;      // per motion
constexpr double kLineWidth = 0.005;     // metres
constexpr double kPointDiameter = 0.02;  // metres

constexpr std::size_t kMinGhosts = 2;
constexpr std::size_t kMaxGhosts = 6;
constexpr BodyColor kStartColor{70, 120, 255, 80};
constexpr BodyColor kGoalColor{50, 210, 100, 80};
constexpr BodyColor kLineColor{0, 204, 51, 255};
constexpr BodyColor kPointColor{0, 204, 204, 255};

/// The states of a path at small joint displacements, and the indices of the waypoints among them.
struct DensePath
{
  std::vector<std::vector<double>> states;
  std::vector<std::size_t> waypoints;
};

DensePath densePathOf(const RobotModel& robot, const std::vector<std::vector<double>>& waypoints)
{
  DensePath path;
  for (std::size_t i = 0; i < waypoints.size(); ++i)
  {
    path.waypoints.push_back(path.states.size());
    path.states.push_back(waypoints[i]);
    if (i + 1 == waypoints.size())
      break;
    const double* from = waypoints[i].data();
    const double* to = waypoints[i + 1].data();
    const double parts = std::min(kMaxSteps, segmentCount(robot, from, to, {kStep, kStep}));
    for (int k = 1; k < static_cast<int>(parts); ++k)
    {
      std::vector<double> state = waypoints[i];
      interpolate(robot, from, to, k / parts, state.data());
      path.states.push_back(std::move(state));
    }
  }
  return path;
}

/// Links that the group moves and that have no child link, such as the hand of an arm.
std::vector<int> lastLinks(const RobotModel& robot, const Group& group)
{
  std::vector<int> links = group.moved_links;
  for (const Joint& joint : robot.joints())
    links.erase(std::remove(links.begin(), links.end(), joint.parent_link), links.end());
  return links;
}

/// The links that the group moves, and the objects that are attached to them.
std::vector<std::size_t> movedBodies(const PlanningScene& scene, const Group& group)
{
  std::vector<std::size_t> bodies(group.moved_links.begin(), group.moved_links.end());
  for (std::size_t i = 0; i < scene.attached.size(); ++i)
    if (std::count(group.moved_links.begin(), group.moved_links.end(), scene.attached[i].link) != 0)
      bodies.push_back(scene.robot->links().size() + scene.objects.size() + i);
  return bodies;
}

BodyColor between(const BodyColor& from, const BodyColor& to, double share)
{
  BodyColor color{};
  for (std::size_t i = 0; i < color.size(); ++i)
    color[i] = static_cast<std::uint8_t>(std::lround((1.0 - share) * from[i] + share * to[i]));
  return color;
}

void addGhosts(const PlanningScene& scene, const DensePath& path, const Group& group, std::size_t max_triangles,
               ShapeMarkers& markers)
{
  const std::vector<std::size_t> bodies = movedBodies(scene, group);
  std::vector<std::size_t> shapes;
  std::size_t triangles = 0;
  for (const std::size_t body : bodies)
    for (const PlacedShape& shape : bodyShapes(scene, body))
    {
      shapes.push_back(trianglesOf(shape.shape));
      triangles += shapes.back();
    }
  const std::size_t ghosts = std::clamp(max_triangles / std::max<std::size_t>(1, triangles), kMinGhosts, kMaxGhosts);
  std::vector<std::size_t> all_shapes;
  for (std::size_t ghost = 0; ghost < ghosts; ++ghost)
    all_shapes.insert(all_shapes.end(), shapes.begin(), shapes.end());
  markers.limitTriangles(max_triangles, std::move(all_shapes));
  for (std::size_t ghost = 0; ghost < ghosts; ++ghost)
  {
    const double share = static_cast<double>(ghost) / static_cast<double>(ghosts - 1);
    const std::size_t at = ghost * (path.states.size() - 1) / (ghosts - 1);
    const auto poses = bodyPoses(scene, path.states[at].data());
    for (const std::size_t body : bodies)
    {
      markers.begin("ghosts", between(kStartColor, kGoalColor, share));
      for (const PlacedShape& shape : bodyShapes(scene, body))
        markers.addShape(shape.shape, poses[body] * shape.pose);
    }
  }
}

void addLines(const RobotModel& robot, const DensePath& path, const Group& group, ShapeMarkers& markers)
{
  std::vector<std::vector<Eigen::Isometry3d>> poses(path.states.size(),
                                                    std::vector<Eigen::Isometry3d>(robot.links().size()));
  for (std::size_t i = 0; i < path.states.size(); ++i)
    robot.linkPoses(path.states[i].data(), poses[i].data());
  const std::vector<int> links = lastLinks(robot, group);
  const auto point_of = [&](std::size_t state, int link)
  { return toPoint(poses[state][static_cast<std::size_t>(link)].translation()); };
  markers.begin("path", kLineColor);
  for (const int link : links)
    if (path.states.size() > 1)
    {
      Marker& line = markers.add(Marker::LINE_STRIP, Eigen::Isometry3d::Identity());
      line.scale.x = kLineWidth;
      for (std::size_t i = 0; i < path.states.size(); ++i)
        line.points.push_back(point_of(i, link));
    }
  if (links.empty())
    return;
  markers.begin("waypoints", kPointColor);
  Marker& points = markers.add(Marker::SPHERE_LIST, Eigen::Isometry3d::Identity());
  setScale(points, Eigen::Vector3d::Constant(kPointDiameter));
  for (const std::size_t waypoint : path.waypoints)
    for (const int link : links)
      points.points.push_back(point_of(waypoint, link));
}
}  // namespace

visualization_msgs::MarkerArray pathMarkers(const PlanningScene& scene,
                                            const std::vector<std::vector<double>>& waypoints, const Group& group,
                                            std::size_t max_triangles)
{
  std_msgs::Header header;
  header.frame_id = scene.robot->planningFrame();
  ShapeMarkers markers(header, {});
  if (waypoints.empty())
    return markers.take();
  const DensePath path = densePathOf(*scene.robot, waypoints);
  addGhosts(scene, path, group, max_triangles, markers);
  addLines(*scene.robot, path, group, markers);
  return markers.take();
}
}  // namespace gpu_planning_scene::core
