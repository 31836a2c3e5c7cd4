#pragma once

#include <cstddef>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The states of a robot that a device can place: all angles are within the range of the shader's sine and cosine.
class PlaceableStates
{
 public:
  explicit PlaceableStates(const RobotModel& robot);

  bool contains(const double* state) const;

 private:
  std::vector<double> largest_;           // magnitude of each variable
  std::vector<std::size_t> quaternions_;  // the first variables of the quaternions of floating joints
};
}  // namespace gpu_planning_scene::core
