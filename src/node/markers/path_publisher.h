#pragma once

#include <memory>

#include <ros/node_handle.h>

#include "node/markers/newest_plan.h"

namespace gpu_planning_scene::core
{
/// Publishes the path and the goals of the last plan on the latched topic ~plan_markers. It publishes at a fixed rate,
/// only if there is a new plan and the topic has subscribers. So no answer of ~plan waits until its path is drawn.
/// Thread-safe.
class PathPublisher
{
 public:
  /// `rate`: per second. `max_triangles`: as in pathMarkers.
  PathPublisher(ros::NodeHandle& own, double rate, std::size_t max_triangles);

  /// Replaces the plan. A plan without a path and without goal regions removes the markers.
  void show(std::shared_ptr<const ShownPlan> plan);

 private:
  void publish();

  const std::size_t max_triangles_;
  ros::Publisher publisher_;
  NewestPlan next_;
  ros::WallTimer timer_;
};
}  // namespace gpu_planning_scene::core
