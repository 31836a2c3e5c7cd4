#include "node/path_markers.h"

#include <algorithm>
#include <cmath>

#include "gpu_planning_scene/interpolation.h"

namespace gpu_planning_scene::core
{
namespace
{
// A straight motion in joint space is a curve in the planning frame, so a line has several points per motion.
constexpr double kStep = 0.05;           // radians and metres between two points of a line
constexpr double kMaxSteps = 200.0;      // per motion
constexpr double kLineWidth = 0.005;     // metres
constexpr double kPointDiameter = 0.02;  // metres

/// Links that the group moves and that have no child link, such as the hand of an arm.
std::vector<int> lastLinks(const RobotModel& robot, const Group& group)
{
  std::vector<int> links = group.moved_links;
  for (const Joint& joint : robot.joints())
    links.erase(std::remove(links.begin(), links.end(), joint.parent_link), links.end());
  return links;
}

geometry_msgs::Point pointOf(const Eigen::Isometry3d& pose)
{
  geometry_msgs::Point point;
  point.x = pose.translation().x();
  point.y = pose.translation().y();
  point.z = pose.translation().z();
  return point;
}

visualization_msgs::Marker marker(const PlanningScene& scene, const std::string& name, int type, double size)
{
  visualization_msgs::Marker made;
  made.header.frame_id = scene.robot->planningFrame();
  made.ns = name;
  made.type = type;
  made.pose.orientation.w = 1.0;
  made.scale.x = made.scale.y = made.scale.z = size;
  made.color.g = 0.8F;
  made.color.b = type == visualization_msgs::Marker::LINE_STRIP ? 0.2F : 0.8F;
  made.color.a = 1.0F;
  return made;
}
}  // namespace

visualization_msgs::MarkerArray pathMarkers(const PlanningScene& scene,
                                            const std::vector<std::vector<double>>& waypoints, const Group& group)
{
  const RobotModel& robot = *scene.robot;
  const std::vector<int> links = lastLinks(robot, group);
  std::vector<visualization_msgs::Marker> lines(
      links.size(), marker(scene, "path", visualization_msgs::Marker::LINE_STRIP, kLineWidth));
  visualization_msgs::Marker points =
      marker(scene, "waypoints", visualization_msgs::Marker::SPHERE_LIST, kPointDiameter);
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  for (std::size_t i = 0; i < waypoints.size(); ++i)
  {
    const std::vector<double>& from = waypoints[i];
    robot.linkPoses(from.data(), poses.data());
    for (const int link : links)
      points.points.push_back(pointOf(poses[static_cast<std::size_t>(link)]));
    const std::vector<double>& to = waypoints[std::min(i + 1, waypoints.size() - 1)];
    const double parts = std::min(kMaxSteps, segmentCount(robot, from.data(), to.data(), {kStep, kStep}));
    std::vector<double> state = from;
    for (int k = 0; k < static_cast<int>(parts); ++k)
    {
      interpolate(robot, from.data(), to.data(), k / parts, state.data());
      robot.linkPoses(state.data(), poses.data());
      for (std::size_t n = 0; n < links.size(); ++n)
        lines[n].points.push_back(pointOf(poses[static_cast<std::size_t>(links[n])]));
    }
  }
  visualization_msgs::MarkerArray array;
  array.markers.emplace_back();
  array.markers.back().action = visualization_msgs::Marker::DELETEALL;
  for (std::size_t n = 0; n < lines.size() && waypoints.size() > 1; ++n)
  {
    lines[n].id = static_cast<int>(n);
    array.markers.push_back(std::move(lines[n]));
  }
  if (!points.points.empty())
    array.markers.push_back(std::move(points));
  return array;
}
}  // namespace gpu_planning_scene::core
