#pragma once

#include <mutex>
#include <string>

#include <sensor_msgs/JointState.h>

#include "gpu_planning_scene/planning_scene.h"
#include "tools/full_states.h"

namespace gpu_planning_scene
{
/// What is known of the robot's state: the scene file's at first, then what joint_states bring. Thread-safe.
class CurrentState
{
 public:
  explicit CurrentState(std::shared_ptr<const PlanningScene> scene);

  PartialState get() const;

  /// Takes the positions of the robot's variables; other names belong to other robots, or to joints without a variable,
  /// and are passed over. Throws Error and takes nothing if the message is malformed or a position is not finite.
  void update(const sensor_msgs::JointState& message);

 private:
  std::shared_ptr<const PlanningScene> scene_;
  mutable std::mutex mutex_;
  PartialState state_;
};
}  // namespace gpu_planning_scene
