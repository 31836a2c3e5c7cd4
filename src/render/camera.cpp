#include <algorithm>
#include <cmath>

#include "base/math_constants.h"
#include "render/drawing.h"
#include "render/renderer.h"

// Own method: cameras around the robot, in two heights, look at the middle of its bounding box and of the objects close
// to it. Each camera has the least distance at which all corners of the box are in the picture.
namespace gpu_planning_scene::core
{
namespace
{
constexpr double kAspect = 4.0 / 3.0;  // width to height of the usual picture
constexpr int kSides = 8;
}  // namespace

Eigen::AlignedBox3d nearRobot(const PlanningScene& scene, const double* state)
{
  const auto poses = bodyPoses(scene, state);
  const std::size_t links = scene.robot->links().size();
  const std::size_t first_attached = links + scene.objects.size();
  Eigen::AlignedBox3d robot;
  for (std::size_t body = 0; body < poses.size(); ++body)
    if (body < links || body >= first_attached)
      robot.extend(bodyBounds(scene, static_cast<int>(body), poses[body]));
  if (robot.isEmpty())
    robot = Eigen::AlignedBox3d(-Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones());
  // The walls of a cell may be far away. Objects within half the robot's diagonal are enough to show where the robot
  // is.
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(0.5 * robot.diagonal().norm());
  const Eigen::AlignedBox3d around(robot.min() - margin, robot.max() + margin);
  Eigen::AlignedBox3d near = robot;
  for (std::size_t body = links; body < first_attached; ++body)
  {
    const Eigen::AlignedBox3d object = bodyBounds(scene, static_cast<int>(body), poses[body]);
    if (!object.isEmpty() && around.intersects(object))
      near.extend(around.intersection(object));
  }
  return near;
}

namespace
{
/// A camera in the direction `side` from the middle of `near`.
Camera cameraAt(const Eigen::AlignedBox3d& near, const Eigen::Vector3d& side, const Eigen::Vector3d& up)
{
  Camera camera;
  camera.up = up;
  camera.target = near.center();
  // The least distance at which all corners of the box are in the picture, plus a little room.
  const Eigen::Vector3d right = up.cross(side).normalized();
  const Eigen::Vector3d top = side.cross(right);
  const double slope = std::tan(0.5 * camera.field_of_view);
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d offset = near.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - camera.target;
    const double lateral = std::max(std::abs(offset.dot(top)), std::abs(offset.dot(right)) / kAspect);
    distance = std::max(distance, offset.dot(side) + lateral / slope);
  }
  camera.eye = camera.target + 1.05 * distance * side;
  return camera;
}
}  // namespace

std::vector<Camera> viewsOf(const PlanningScene& scene, const double* state, const Eigen::Vector3d& up)
{
  const Eigen::AlignedBox3d near = nearRobot(scene, state);
  const Eigen::Quaterniond upright = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  std::vector<Camera> views;
  for (const double height : {0.55, 1.1})
    for (int i = 0; i < kSides; ++i)
    {
      const Eigen::Vector3d front = Eigen::Vector3d(1.0, -0.75, height).normalized();
      const Eigen::AngleAxisd turn(2.0 * kPi * i / kSides, Eigen::Vector3d::UnitZ());
      views.push_back(cameraAt(near, upright * (turn * front), up));
    }
  return views;
}
}  // namespace gpu_planning_scene::core
