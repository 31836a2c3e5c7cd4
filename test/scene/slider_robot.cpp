#include "scene/slider_robot.h"

#include <fstream>
#include <iterator>

namespace gpu_planning_scene::core
{
namespace
{
std::string contentOf(const std::string& name)
{
  std::ifstream file(std::string(GPS_SOURCE_DIR) + "/test/scene/" + name);
  return std::string(std::istreambuf_iterator<char>(file), {});
}
}  // namespace

std::string sliderUrdf()
{
  return contentOf("slider.urdf");
}

std::string sliderSrdf()
{
  return contentOf("slider.srdf");
}

std::shared_ptr<const RobotModel> sliderRobot()
{
  return RobotModel::fromXml(sliderUrdf(), sliderSrdf(), {});
}

std::shared_ptr<const RobotModel> sliderRobotOnFloor(const std::string& joint_type)
{
  std::string srdf = sliderSrdf();
  srdf.insert(srdf.find("</robot>"),
              "<virtual_joint name=\"floor\" type=\"" + joint_type + "\" parent_frame=\"hall\" child_link=\"rail\"/>");
  return RobotModel::fromXml(sliderUrdf(), srdf, {});
}

PlanningScene sliderAndWall(std::uint64_t revision)
{
  PlanningScene scene(sliderRobot());
  WorldObject wall;
  wall.id = "wall";
  wall.pose.translation() = Eigen::Vector3d(1.0, 0.0, 0.0);
  wall.shapes.push_back({Box{Eigen::Vector3d(0.2, 1.0, 0.2)}, Eigen::Isometry3d::Identity()});
  scene.objects.push_back(wall);
  scene.revision = revision;
  return scene;
}
}  // namespace gpu_planning_scene::core
