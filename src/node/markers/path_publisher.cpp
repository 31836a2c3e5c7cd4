#include "node/markers/path_publisher.h"

#include <utility>

#include "node/markers/path_markers.h"

namespace gpu_planning_scene::core
{
PathPublisher::PathPublisher(ros::NodeHandle& own, double rate, std::size_t max_triangles)
  : max_triangles_(max_triangles),
    publisher_(own.advertise<visualization_msgs::MarkerArray>("plan_markers", 1, true)),
    timer_(own.createWallTimer(ros::WallDuration(1.0 / rate), [this](const ros::WallTimerEvent&) { publish(); }))
{
}

void PathPublisher::show(std::shared_ptr<const PlanningScene> scene, std::vector<std::vector<double>> waypoints,
                         const Group& group)
{
  auto path = std::make_unique<const Path>(Path{std::move(scene), std::move(waypoints), group});
  const std::lock_guard<std::mutex> lock(mutex_);
  next_ = std::move(path);
}

void PathPublisher::publish()
{
  if (publisher_.getNumSubscribers() == 0)
    return;
  std::unique_ptr<const Path> path;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    path = std::move(next_);
  }
  if (path)
    publisher_.publish(pathMarkers(*path->scene, path->waypoints, path->group, max_triangles_));
}
}  // namespace gpu_planning_scene::core
