#include "node/markers/path_markers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "gpu_planning_scene/interpolation.h"
#include "node/markers/moved_bodies.h"
#include "node/markers/shape_markers.h"
#include "node/messages/pose_messages.h"
#include "render/renderer.h"

namespace gpu_planning_scene::core
{
namespace
{
using visualization_msgs::Marker;

// A straight motion in joint space is a curve in the planning frame, so a line has several points per motion.
constexpr double kStep = 0.05;           // radians and metres between two points of a line
constexpr double kMaxSteps = 200.0;      // per motion
constexpr double kLineWidth = 0.012;     // metres
constexpr double kPointDiameter = 0.02;  // metres

constexpr std::size_t kMaxGhosts = 4;
constexpr BodyColor kStartColor{70, 120, 255, 90};
constexpr BodyColor kGoalColor{50, 210, 100, 90};
constexpr std::uint8_t kFaint = 40;     // opacity of the ghosts between start and goal
constexpr double kLetterHeight = 0.05;  // of the size of the moved bodies
constexpr BodyColor kStartText{20, 60, 200, 255};
constexpr BodyColor kGoalText{0, 120, 40, 255};
constexpr BodyColor kLineColor{200, 0, 200, 255};
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
    const double segments = std::min(kMaxSteps, segmentCount(robot, from, to, {kStep, kStep}));
    for (int k = 1; k < static_cast<int>(segments); ++k)
    {
      std::vector<double> state = waypoints[i];
      interpolate(robot, from, to, k / segments, state.data());
      path.states.push_back(std::move(state));
    }
  }
  return path;
}

/// Links that the group moves and that have no child link. For several such links with one parent, for example the
/// fingers of a hand, the parent.
std::vector<int> lastLinks(const RobotModel& robot, const Group& group)
{
  std::vector<int> links = group.moved_links;
  for (const Joint& joint : robot.joints())
    links.erase(std::remove(links.begin(), links.end(), joint.parent_link), links.end());
  const auto parent_of = [&robot](int link)
  {
    const int joint = robot.links()[static_cast<std::size_t>(link)].parent_joint;
    return joint < 0 ? -1 : robot.joints()[static_cast<std::size_t>(joint)].parent_link;
  };
  std::set<int> ends;
  for (const int link : links)
  {
    const int parent = parent_of(link);
    const auto siblings =
        std::count_if(links.begin(), links.end(), [&](int other) { return parent_of(other) == parent; });
    ends.insert(siblings > 1 && parent >= 0 ? parent : link);
  }
  return {ends.begin(), ends.end()};
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
  std::vector<std::vector<Eigen::Isometry3d>> poses;
  for (std::size_t ghost = 0; ghost < kMaxGhosts; ++ghost)
    poses.push_back(bodyPoses(scene, path.states[ghost * (path.states.size() - 1) / (kMaxGhosts - 1)].data()));
  const std::vector<std::size_t> bodies = movedBodies(scene, group, poses);
  std::vector<std::size_t> shapes;
  std::size_t triangles = 0;
  for (const std::size_t body : bodies)
    for (const PlacedShape& shape : bodyShapes(scene, body))
    {
      shapes.push_back(trianglesOf(shape.shape));
      triangles += shapes.back();
    }
  std::vector<std::size_t> drawn = {0, kMaxGhosts - 1};
  if (max_triangles / kMaxGhosts >= triangles)
    drawn = {0, 1, 2, kMaxGhosts - 1};
  std::vector<std::size_t> all_shapes;
  for (std::size_t ghost = 0; ghost < drawn.size(); ++ghost)
    all_shapes.insert(all_shapes.end(), shapes.begin(), shapes.end());
  markers.limitTriangles(max_triangles, std::move(all_shapes));
  for (const std::size_t ghost : drawn)
  {
    BodyColor color =
        between(kStartColor, kGoalColor, static_cast<double>(ghost) / static_cast<double>(kMaxGhosts - 1));
    if (ghost != drawn.front() && ghost != drawn.back())
      color[3] = kFaint;
    for (const std::size_t body : bodies)
    {
      markers.begin("ghosts", color);
      for (const PlacedShape& shape : bodyShapes(scene, body))
        markers.addShape(shape.shape, poses[ghost][body] * shape.pose);
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
  { return pointOf(poses[state][static_cast<std::size_t>(link)].translation()); };
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

/// The point on the ray at which it leaves the box. `from`: inside the box.
Eigen::Vector3d exitOf(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
{
  double exit = std::numeric_limits<double>::max();
  for (int axis = 0; axis < 3; ++axis)
    if (direction[axis] != 0.0)
      exit = std::min(exit, ((direction[axis] > 0.0 ? box.max() : box.min())[axis] - from[axis]) / direction[axis]);
  return from + exit * direction;
}

/// Labels of start and goal. A label inside a ghost would be hidden. So it stands outside the boxes around the first
/// and the last ghost, in the direction of the last link.
void addLabels(const PlanningScene& scene, const DensePath& path, const Group& group, ShapeMarkers& markers)
{
  const std::vector<int> links = lastLinks(*scene.robot, group);
  if (links.empty())
    return;
  const auto tip = static_cast<std::size_t>(links.front());
  const std::vector<std::vector<Eigen::Isometry3d>> poses = {bodyPoses(scene, path.states.front().data()),
                                                             bodyPoses(scene, path.states.back().data())};
  std::vector<Eigen::AlignedBox3d> boxes;
  double size = 0.2;  // metres, even if the moved bodies are smaller
  for (const std::vector<Eigen::Isometry3d>& at : poses)
  {
    boxes.emplace_back(at[tip].translation());
    for (const std::size_t body : movedBodies(scene, group, poses))
      boxes.back().extend(bodyBounds(scene, static_cast<int>(body), at[body]));
    size = std::max(size, boxes.back().diagonal().norm());
  }
  const double height = kLetterHeight * size;
  const double margin = 2.0 * height;  // half the width of a label
  std::vector<Eigen::Vector3d> places;
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    const Eigen::Vector3d end = poses[i][tip].translation();
    const Eigen::Vector3d outwards = end - boxes[i].center();
    const Eigen::Vector3d direction =
        outwards.norm() > kUnmoved ? outwards.normalized() : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
    places.push_back(exitOf(boxes[i], end, direction) + margin * direction);
    if (boxes[1 - i].contains(places.back()))
      places.back() = exitOf(boxes[1 - i], places.back(), direction) + margin * direction;
  }
  if ((places[1] - places[0]).norm() < 2.0 * height)
    places[1].z() += 2.0 * height;  // one label must not cover the other
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    markers.begin("labels", i == 0 ? kStartText : kGoalText);
    Marker& marker = markers.add(Marker::TEXT_VIEW_FACING, Eigen::Isometry3d::Identity());
    marker.pose.position = pointOf(places[i]);
    marker.scale.z = height;
    marker.text = i == 0 ? "start" : "goal";
  }
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
  addLabels(scene, path, group, markers);
  return markers.take();
}
}  // namespace gpu_planning_scene::core
