#pragma once

#include <memory>
#include <mutex>

#include <ros/node_handle.h>

#include "gpu_planning_scene/state_inspector.h"
#include "node/markers/scene_markers.h"
#include "node/messages/messages.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Publishes the scene on the latched topic ~markers: the robot in its current state, the objects, colliding bodies,
/// contact points, and the requested tree boxes. It publishes at a fixed rate, only if something has changed and the
/// topic has subscribers.
class MarkerPublisher
{
 public:
  /// `rate`: per second.
  MarkerPublisher(ros::NodeHandle& own, const SceneStore& store, double rate, std::size_t max_triangles);

  /// Throws nothing: the response has the error.
  ShowTreeLevel::Response show(const ShowTreeLevel::Request& request);

 private:
  void publish();

  const SceneStore& store_;
  ros::Publisher publisher_;
  std::mutex mutex_;  // guards the members below
  MarkerOptions options_;
  Snapshot drawn_;
  bool changed_ = true;
  std::unique_ptr<const StateInspector> inspector_;
  ros::WallTimer timer_;
};
}  // namespace gpu_planning_scene::core
