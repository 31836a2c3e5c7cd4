#include "node/markers/animation_publisher.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "node/markers/shape_markers.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint32_t kMostWaiting = 10;  // messages to a slow subscriber; it must not miss one that deletes
}  // namespace

AnimationPublisher::AnimationPublisher(ros::NodeHandle& own, double rate, std::size_t max_triangles)
  : max_triangles_(static_cast<std::size_t>(static_cast<double>(max_triangles) / std::max(1.0, rate)))
{
  if (rate <= 0.0)
    return;
  publisher_ = own.advertise<visualization_msgs::MarkerArray>("plan_animation", kMostWaiting);
  timer_ = own.createWallTimer(ros::WallDuration(1.0 / rate), [this](const ros::WallTimerEvent&) { publish(); });
}

void AnimationPublisher::show(std::shared_ptr<const ShownPlan> plan)
{
  if (!publisher_)
    return;
  next_.put(std::move(plan));
}

/// Returns a message that deletes the markers of the plan before.
visualization_msgs::MarkerArray AnimationPublisher::begin(const ShownPlan& plan)
{
  robot_ = plan.scene->robot;
  bodies_.reset();
  published_.clear();
  if (!plan.waypoints.empty())
  {
    path_ = plan.timed ? pathAtItsTimes(*plan.timed) : pathAtConstantSpeed(*robot_, plan.waypoints);
    bodies_.emplace(*plan.scene, plan.group, plan.waypoints, max_triangles_);
    beginning_ = std::chrono::steady_clock::now();
  }
  std_msgs::Header header;
  header.frame_id = robot_->planningFrame();
  return ShapeMarkers(header, {}).take();
}

void AnimationPublisher::publish()
{
  const std::size_t before = std::exchange(subscribers_, publisher_.getNumSubscribers());
  if (subscribers_ == 0)
    return;
  const std::shared_ptr<const ShownPlan> plan = next_.take();
  if (plan)
    publisher_.publish(begin(*plan));
  if (!bodies_)
    return;
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - beginning_;
  std::vector<double> state = animatedState(*robot_, path_, since.count());
  if (state == published_ && subscribers_ <= before)
    return;
  publisher_.publish(bodies_->at(state));
  published_ = std::move(state);
}
}  // namespace gpu_planning_scene::core
