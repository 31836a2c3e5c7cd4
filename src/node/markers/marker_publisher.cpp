#include "node/markers/marker_publisher.h"

#include <algorithm>

#include "node/endpoints/respond.h"
#include "render/drawing.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMaxContacts = 1000;

/// The markers show a robot with unknown joint values in its default state, perhaps in collision. The services refuse
/// to check this state, so users need an explanation.
void warnOfUnknownState(const Snapshot& now)
{
  const std::vector<bool> known = now.partialState().known;
  if (std::find(known.begin(), known.end(), false) != known.end())
    ROS_WARN_ONCE(
        "the current state is not known yet, so RViz shows the robot with default joint values; set it with "
        "the topic joint_states, with robot_state.joint_state in the scene file, or with "
        "~apply_planning_scene");
}
}  // namespace

MarkerPublisher::MarkerPublisher(ros::NodeHandle& own, const SceneStore& store, double rate, std::size_t max_triangles)
  : store_(store), publisher_(own.advertise<visualization_msgs::MarkerArray>("markers", 1, true))
{
  options_.max_triangles = max_triangles;
  timer_ = own.createWallTimer(ros::WallDuration(1.0 / rate), [this](const ros::WallTimerEvent&) { publish(); });
}

ShowTreeLevel::Response MarkerPublisher::show(const ShowTreeLevel::Request& request)
{
  return respond<ShowTreeLevel::Response>(
      [&](ShowTreeLevel::Response&)
      {
        requireTreeLevel(*store_.snapshot().scene, request.level, request.body);
        const std::lock_guard<std::mutex> lock(mutex_);
        options_.tree_level = request.level;
        options_.tree_body = request.body;
        changed_ = true;
      });
}

void MarkerPublisher::publish()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (publisher_.getNumSubscribers() == 0)
    return;
  try
  {
    Snapshot now = store_.snapshot();
    if (!changed_ && now.scene == drawn_.scene && now.state == drawn_.state)
      return;
    if (!inspector_ || now.scene != drawn_.scene)
      inspector_ = std::make_unique<const StateInspector>(now.scene, inspector_.get());
    std::vector<BodyPair> colliding;
    std::vector<Eigen::Vector3d> points;
    for (const Contact& contact : inspector_->contacts(now.state.data(), "", kMaxContacts, kMaxContactsOfPair))
    {
      colliding.push_back(contact.bodies);
      points.push_back(contact.point);
    }
    options_.stamp = ros::Time::now();
    warnOfUnknownState(now);
    publisher_.publish(markersOf(*now.scene, now.state.data(), colliding, points, options_));
    drawn_ = std::move(now);
    changed_ = false;
  }
  catch (const std::exception& error)
  {
    ROS_WARN_STREAM_THROTTLE(10.0, "markers: " << error.what());
  }
}
}  // namespace gpu_planning_scene::core
