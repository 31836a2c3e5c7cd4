#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <ros/node_handle.h>

#include "node/markers/animated_bodies.h"
#include "node/markers/newest_plan.h"
#include "node/markers/path_animation.h"

namespace gpu_planning_scene::core
{
/// Shows the motion of the last plan again and again on the topic ~plan_animation. It publishes only while the topic
/// has subscribers and the bodies move. RViz needs the triangles of a mesh in every message. Thread-safe.
class AnimationPublisher
{
 public:
  /// `rate`: messages per second; 0: the topic is not advertised. `max_triangles`: per second.
  AnimationPublisher(ros::NodeHandle& own, double rate, std::size_t max_triangles);

  /// Replaces the motion. A plan without a path removes the markers.
  void show(std::shared_ptr<const ShownPlan> plan);

 private:
  void publish();
  visualization_msgs::MarkerArray begin(const ShownPlan& plan);

  const std::size_t max_triangles_;  // of a message
  ros::Publisher publisher_;
  NewestPlan next_;

  // Of the timer's thread.
  std::shared_ptr<const RobotModel> robot_;
  AnimatedPath path_;
  std::optional<AnimatedBodies> bodies_;  // no value: there is no path
  std::chrono::steady_clock::time_point beginning_;
  std::vector<double> published_;  // the last state
  std::size_t subscribers_ = 0;    // of the last message

  ros::WallTimer timer_;
};
}  // namespace gpu_planning_scene::core
