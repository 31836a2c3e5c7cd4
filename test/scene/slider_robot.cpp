#include "scene/slider_robot.h"

#include <fstream>
#include <iterator>

#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string contentOf(const std::string& name)
{
  std::ifstream file(std::string(GPS_SOURCE_DIR) + "/test/scene/" + name);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// An OBJ file of a cube of 1 m around the origin, without its side at x > 0.
const char* const kTrough =
    "v -0.5 -0.5 -0.5\nv 0.5 -0.5 -0.5\nv 0.5 0.5 -0.5\nv -0.5 0.5 -0.5\n"
    "v -0.5 -0.5 0.5\nv 0.5 -0.5 0.5\nv 0.5 0.5 0.5\nv -0.5 0.5 0.5\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\n";
const char* const kSide = "f 2 3 7 6\n";  // the side at x > 0

/// The URDF with meshes in `folder`.
std::string urdfOfMeshes(const TemporaryFolder& folder)
{
  std::string urdf = sliderUrdf();
  for (const auto& [size, faces] : {std::pair<std::string, std::string>("0.2 0.2 0.2", kSide), {"0.1 0.1 0.4", ""}})
  {
    const std::string box = "<box size=\"" + size + "\"/>";
    urdf.replace(urdf.find(box), box.size(),
                 "<mesh filename=\"" + folder.write(size + ".obj", kTrough + faces) + "\" scale=\"" + size + "\"/>");
  }
  return urdf;
}

std::string srdfWithFloor(const std::string& joint_type)
{
  std::string srdf = sliderSrdf();
  return srdf.insert(srdf.find("</robot>"), "<virtual_joint name=\"floor\" type=\"" + joint_type +
                                                "\" parent_frame=\"hall\" child_link=\"rail\"/>");
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
  return RobotModel::fromXml(sliderUrdf(), srdfWithFloor(joint_type), {});
}

std::shared_ptr<const RobotModel> sliderRobotOfMeshes()
{
  return RobotModel::fromXml(urdfOfMeshes(TemporaryFolder()), sliderSrdf(), {});
}

std::shared_ptr<const RobotModel> sliderRobotOfMeshes(const std::string& joint_type)
{
  return RobotModel::fromXml(urdfOfMeshes(TemporaryFolder()), srdfWithFloor(joint_type), {});
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
