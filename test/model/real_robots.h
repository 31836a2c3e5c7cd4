#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Sets the folder of robots and problems: urdf/ with the robots of Debian's dart-doc, robots/ and problems/ as in
/// ../shared. Without this call the folder is $GPU_PLANNING_SCENE_DATA if it is set, else the folders that the build
/// was configured with.
void useDataFolder(const std::string& folder);

/// The folder of a set of problems of ur5_robotiq, with scenes and motion requests.
std::string problemFolder(const std::string& set);

/// A robot that is not part of the project. It comes from Debian's dart-doc or from ../shared.
struct RealRobot
{
  std::string name;
  std::string urdf;
  std::string srdf;  ///< empty if the robot has no SRDF
  std::map<std::string, std::string> packages;

  bool available() const;
  std::string urdfText() const;
  std::string srdfText() const;
  std::shared_ptr<const RobotModel> load(std::vector<std::string>* warnings = nullptr) const;
};

RealRobot kr5();
RealRobot wam();
RealRobot drchubo();
RealRobot ur5Robotiq();
/// VAMP's sphere model of ur5_robotiq, with the SRDF of ur5_robotiq.
RealRobot ur5Spheres();
/// Panda with the SRDF of MoveIt's tests, whose virtual joint is floating.
RealRobot panda();

/// PR2 with the SRDF of MoveIt's tests, whose virtual joint is planar.
RealRobot pr2();

/// A humanoid, many of whose meshes have open seams.
RealRobot g1();

/// The robots whose files exist, without the sphere model.
std::vector<RealRobot> realRobots();
}  // namespace gpu_planning_scene::core

/// Skips the test if the robot is missing.
#define SKIP_WITHOUT(robot)                         \
  if (!(robot).available())                         \
    GTEST_SKIP() << "there is no " << (robot).urdf; \
  static_assert(true, "")
