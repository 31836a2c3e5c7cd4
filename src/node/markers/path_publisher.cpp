#include "node/markers/path_publisher.h"

#include <utility>

#include "node/markers/goal_markers.h"
#include "node/markers/path_markers.h"

namespace gpu_planning_scene::core
{
PathPublisher::PathPublisher(ros::NodeHandle& own, double rate, std::size_t max_triangles)
  : max_triangles_(max_triangles),
    publisher_(own.advertise<visualization_msgs::MarkerArray>("plan_markers", 1, true)),
    timer_(own.createWallTimer(ros::WallDuration(1.0 / rate), [this](const ros::WallTimerEvent&) { publish(); }))
{
}

void PathPublisher::show(std::shared_ptr<const ShownPlan> plan)
{
  next_.put(std::move(plan));
}

void PathPublisher::publish()
{
  if (publisher_.getNumSubscribers() == 0)
    return;
  const std::shared_ptr<const ShownPlan> plan = next_.take();
  if (!plan)
    return;
  visualization_msgs::MarkerArray array = pathMarkers(*plan->scene, plan->waypoints, plan->group, max_triangles_);
  for (visualization_msgs::Marker& marker : goalMarkers(*plan))
    array.markers.push_back(std::move(marker));
  publisher_.publish(array);
}
}  // namespace gpu_planning_scene::core
