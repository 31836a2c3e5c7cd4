#include "model/real_robots.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace gpu_planning_scene::core
{
namespace
{
/// If the string is empty, the folders that the build was configured with are used.
std::string& chosenFolder()
{
  static std::string folder = []
  {
    const char* set = std::getenv("GPU_PLANNING_SCENE_DATA");
    return std::string(set != nullptr ? set : "");
  }();
  return folder;
}

std::string chosenOr(const std::string& built_in)
{
  return chosenFolder().empty() ? built_in : chosenFolder();
}

std::string dartRobot(const std::string& path)
{
  return chosenOr(GPS_DART_DATA_DIR) + "/urdf/" + path;
}

std::string readFile(const std::string& path)
{
  std::ifstream file(path);
  return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}
}  // namespace

void useDataFolder(const std::string& folder)
{
  chosenFolder() = folder;
}

std::string problemFolder(const std::string& set)
{
  return chosenOr(GPS_SHARED_DIR) + "/problems/ur5/" + set;
}

bool RealRobot::available() const
{
  return std::filesystem::exists(urdf);
}

std::string RealRobot::urdfText() const
{
  return readFile(urdf);
}

std::string RealRobot::srdfText() const
{
  return readFile(srdf);
}

std::shared_ptr<const RobotModel> RealRobot::load(std::vector<std::string>* warnings) const
{
  RobotModelOptions options;
  options.packages = packageResolver(packages);
  return RobotModel::fromFiles(urdf, srdf, options, warnings);
}

RealRobot kr5()
{
  return {"KR5", dartRobot("KR5/KR5 sixx R650.urdf"), "", {}};
}

RealRobot wam()
{
  return {"WAM", dartRobot("wam/wam.urdf"), "", {{"herb_description", dartRobot("wam")}}};
}

RealRobot drchubo()
{
  return {"DRC-Hubo", dartRobot("drchubo/drchubo.urdf"), "", {{"drchubo", dartRobot("drchubo")}}};
}

RealRobot ur5Robotiq()
{
  const std::string folder = chosenOr(GPS_SHARED_DIR) + "/robots/ur5_robotiq";
  return {"ur5_robotiq", folder + "/urdf/ur5.urdf", folder + "/srdf/ur5.srdf", {{"ur5_robotiq", folder}}};
}

RealRobot ur5Spheres()
{
  return {"ur5_spheres", chosenOr(GPS_SHARED_DIR) + "/vamp/ur5_spherized.urdf", ur5Robotiq().srdf, {}};
}

RealRobot panda()
{
  const std::string folder = chosenOr(GPS_SHARED_DIR) + "/moveit/resources/panda_";
  return {"panda",
          folder + "description/urdf/panda.urdf",
          folder + "moveit_config/config/panda.srdf",
          {{"moveit_resources_panda_description", folder + "description"}}};
}

RealRobot pr2()
{
  const std::string folder = chosenOr(GPS_SHARED_DIR) + "/moveit/resources/pr2_description";
  return {
      "PR2", folder + "/urdf/robot.xml", folder + "/srdf/robot.xml", {{"moveit_resources_pr2_description", folder}}};
}

RealRobot g1()
{
  return {"G1", chosenOr(GPS_SHARED_DIR) + "/cases/g1/g1_29dof.urdf", "", {}};
}

std::vector<RealRobot> realRobots()
{
  std::vector<RealRobot> robots;
  for (const RealRobot& robot : {kr5(), wam(), drchubo(), ur5Robotiq(), panda()})
    if (robot.available())
      robots.push_back(robot);
  return robots;
}
}  // namespace gpu_planning_scene::core
