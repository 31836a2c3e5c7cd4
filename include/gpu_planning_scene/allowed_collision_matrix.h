#pragma once

#include <map>
#include <string>
#include <utility>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene
{
/// Which pairs of bodies may touch, by name (links and objects). As in MoveIt: an entry for the pair decides; without
/// one the default entries of the two bodies do (both present: allowed only if both allow; one present: that one);
/// without either the pair is checked.
class AllowedCollisionMatrix
{
 public:
  /// The SRDF's matrix; without an SRDF the adjacent links are allowed.
  static AllowedCollisionMatrix fromRobot(const RobotModel& robot);

  void setEntry(const std::string& body_1, const std::string& body_2, bool allowed);
  void setDefault(const std::string& body, bool allowed);
  bool allowed(const std::string& body_1, const std::string& body_2) const;

 private:
  std::map<std::pair<std::string, std::string>, bool> entries_;  // keys in ascending order
  std::map<std::string, bool> defaults_;
};
}  // namespace gpu_planning_scene
