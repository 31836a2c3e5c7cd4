#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include <ros/node_handle.h>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Publishes the last planned path on the latched topic ~plan_markers. It publishes at a fixed rate, only if there is a
/// new path and the topic has subscribers. So no answer of ~plan waits until its path is drawn. Thread-safe.
class PathPublisher
{
 public:
  /// `rate`: per second. `max_triangles`: as in pathMarkers.
  PathPublisher(ros::NodeHandle& own, double rate, std::size_t max_triangles);

  /// Replaces the path. An empty path removes the markers. `waypoints`: rows of all variables.
  void show(std::shared_ptr<const PlanningScene> scene, std::vector<std::vector<double>> waypoints, const Group& group);

 private:
  struct Path
  {
    std::shared_ptr<const PlanningScene> scene;
    std::vector<std::vector<double>> waypoints;
    Group group;
  };

  void publish();

  const std::size_t max_triangles_;
  ros::Publisher publisher_;
  std::mutex mutex_;
  std::unique_ptr<const Path> next_;  // guarded by mutex_; null after it was published
  ros::WallTimer timer_;
};
}  // namespace gpu_planning_scene::core
