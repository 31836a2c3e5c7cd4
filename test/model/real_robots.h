#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene
{
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
}  // namespace gpu_planning_scene

/// Skips the test where the robot is missing.
#define SKIP_WITHOUT(robot)                         \
  if (!(robot).available())                         \
  {                                                 \
    GTEST_SKIP() << "there is no " << (robot).urdf; \
  }                                                 \
  static_assert(true, "")
