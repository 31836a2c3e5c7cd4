#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// From now on the robots and problems are those of `folder`: urdf/ with the robots of Debian's dart-doc, robots/ and
/// problems/ as in ../shared. Without it they are in $GPU_PLANNING_SCENE_DATA if set, else where the build was told.
void useDataFolder(const std::string& folder);

/// Where a set of problems of ur5_robotiq lies: scenes and motion requests.
std::string problemFolder(const std::string& set);

/// A robot that is not part of the project: Debian's dart-doc has some, ../shared another.
struct RealRobot
{
  std::string name;
  std::string urdf;
  std::string srdf;  ///< empty: none
  std::map<std::string, std::string> packages;

  bool available() const;
  std::string urdfText() const;
  std::shared_ptr<const RobotModel> load(std::vector<std::string>* warnings = nullptr) const;
};

RealRobot kr5();
RealRobot wam();
RealRobot drchubo();
RealRobot ur5Robotiq();

/// Those that are there.
std::vector<RealRobot> realRobots();
}  // namespace gpu_planning_scene::core

/// Skips the test where the robot is missing.
#define SKIP_WITHOUT(robot)                         \
  if (!(robot).available())                         \
    GTEST_SKIP() << "there is no " << (robot).urdf; \
  static_assert(true, "")
