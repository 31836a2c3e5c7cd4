#include "real_robots.h"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace gpu_planning_scene
{
namespace
{
const std::string kDart = std::string(GPS_DART_DATA_DIR) + "/urdf/";
const std::string kShared = std::string(GPS_SHARED_DIR) + "/robots/";
}  // namespace

bool RealRobot::available() const
{
  return std::filesystem::exists(urdf);
}

std::string RealRobot::urdfText() const
{
  std::ifstream file(urdf);
  return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

std::shared_ptr<const RobotModel> RealRobot::load(std::vector<std::string>* warnings) const
{
  RobotModelOptions options;
  options.packages = packageResolver(packages);
  return RobotModel::fromFiles(urdf, srdf, options, warnings);
}

RealRobot kr5()
{
  return {"KR5", kDart + "KR5/KR5 sixx R650.urdf", "", {}};
}

RealRobot wam()
{
  return {"WAM", kDart + "wam/wam.urdf", "", {{"herb_description", kDart + "wam"}}};
}

RealRobot drchubo()
{
  return {"DRC-Hubo", kDart + "drchubo/drchubo.urdf", "", {{"drchubo", kDart + "drchubo"}}};
}

RealRobot ur5Robotiq()
{
  const std::string folder = kShared + "ur5_robotiq";
  return {"ur5_robotiq", folder + "/urdf/ur5.urdf", folder + "/srdf/ur5.srdf", {{"ur5_robotiq", folder}}};
}

std::vector<RealRobot> realRobots()
{
  std::vector<RealRobot> robots;
  for (const RealRobot& robot : {kr5(), wam(), drchubo(), ur5Robotiq()})
  {
    if (robot.available())
    {
      robots.push_back(robot);
    }
  }
  return robots;
}
}  // namespace gpu_planning_scene
