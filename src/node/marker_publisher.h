#pragma once

#include <memory>
#include <mutex>

#include <ros/node_handle.h>

#include "gpu_planning_scene/state_inspector.h"
#include "node/markers.h"
#include "node/messages.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Draws the scene on ~markers while somebody looks: the robot in its current state, the objects, what collides,
/// contact points, and the boxes that were asked for. Latched, at a rate, and only where something has changed.
class MarkerPublisher
{
 public:
  /// `rate`: per second.
  MarkerPublisher(ros::NodeHandle& own, const SceneStore& store, double rate, std::size_t most_triangles);

  /// Throws nothing: what is wrong with the request is said in the response.
  ShowTreeLevel::Response show(const ShowTreeLevel::Request& request);

 private:
  void publish();

  const SceneStore& store_;
  ros::Publisher publisher_;
  std::mutex mutex_;  // of what follows
  MarkerOptions options_;
  Snapshot drawn_;
  bool changed_ = true;
  std::unique_ptr<const StateInspector> inspector_;
  ros::WallTimer timer_;
};
}  // namespace gpu_planning_scene::core
