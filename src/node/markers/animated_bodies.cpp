#include "node/markers/animated_bodies.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "node/markers/moved_bodies.h"
#include "node/markers/shape_markers.h"
#include "node/messages/object_from_message.h"
#include "node/messages/pose_messages.h"
#include "render/drawing.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr BodyColor kAnimationColor{190, 100, 200, 150};
constexpr std::size_t kMaxSampledStates = 16;  // of the path, to find the bodies that move

std::vector<std::size_t> bodiesThatMove(const PlanningScene& scene, const Group& group,
                                        const std::vector<std::vector<double>>& path)
{
  std::vector<std::vector<Eigen::Isometry3d>> poses;
  const std::size_t count = std::min(kMaxSampledStates, path.size());
  for (std::size_t i = 0; i < count; ++i)
    poses.push_back(bodyPoses(scene, path[i * (path.size() - 1) / std::max<std::size_t>(1, count - 1)].data()));
  return movedBodies(scene, group, poses);
}
}  // namespace

AnimatedBodies::AnimatedBodies(const PlanningScene& scene, const Group& group,
                               const std::vector<std::vector<double>>& path, std::size_t max_triangles)
  : robot_(scene.robot)
{
  const std::vector<std::size_t> bodies = bodiesThatMove(scene, group, path);
  std::vector<std::size_t> triangles;
  for (const std::size_t body : bodies)
    for (const PlacedShape& shape : bodyShapes(scene, body))
      triangles.push_back(trianglesOf(shape.shape));
  std_msgs::Header header;
  header.frame_id = robot_->planningFrame();
  ShapeMarkers markers(header, {});
  markers.limitTriangles(max_triangles, std::move(triangles));
  const std::size_t links = robot_->links().size();
  for (const std::size_t body : bodies)
  {
    Place place{body, Eigen::Isometry3d::Identity()};
    if (body >= links)
    {
      const AttachedObject& attached = scene.attached[body - links - scene.objects.size()];
      place = {static_cast<std::size_t>(attached.link), attached.object.pose};
    }
    markers.begin("animation", kAnimationColor);
    for (const PlacedShape& shape : bodyShapes(scene, body))
      if (!std::holds_alternative<HalfSpace>(shape.shape))
        markers.addShape(shape.shape, place.pose * shape.pose);
    places_.resize(markers.size(), place);
  }
  array_ = markers.take();
  places_.resize(array_.markers.size());
  places_.erase(places_.begin());
  array_.markers.erase(array_.markers.begin());  // deletes all markers, and would make RViz build them anew
  for (std::size_t i = 0; i < places_.size(); ++i)
    places_[i].pose = isometryOf(array_.markers[i].pose);
}

const visualization_msgs::MarkerArray& AnimatedBodies::at(const std::vector<double>& state)
{
  std::vector<Eigen::Isometry3d> poses(robot_->links().size());
  robot_->linkPoses(state.data(), poses.data());
  for (std::size_t i = 0; i < places_.size(); ++i)
    array_.markers[i].pose = poseOf(poses[places_[i].link] * places_[i].pose);
  return array_;
}
}  // namespace gpu_planning_scene::core
