#pragma once

#include <string>
#include <utility>
#include <vector>

#include <moveit/planning_scene/planning_scene.h>

namespace gpu_planning_scene
{
/// A running planning_scene_node with ~moveit_names. It has the robot of the study.
class StudyNode
{
 public:
  /// Waits for the node. `name`: its full name, for example "/planning_scene". Throws std::runtime_error if it does not
  /// come up.
  explicit StudyNode(std::string name);

  /// Sends the scene in MoveIt's message, with `state` as its current state. Throws std::runtime_error if the node
  /// refuses it.
  void setScene(const planning_scene::PlanningScene& scene, const moveit::core::RobotState& state) const;

  /// For each state, a pair of bodies that collides by ~check_states; empty names if the state is free. `rows`: all
  /// variables of the active joints, in MoveIt's order. Throws std::runtime_error if the node refuses the states.
  std::vector<std::pair<std::string, std::string>> collidingPairs(const moveit::core::RobotModel& robot,
                                                                  const std::vector<double>& rows) const;

 private:
  std::string name_;
};

/// The variables of the active joints, in MoveIt's order.
std::vector<std::string> activeVariables(const moveit::core::RobotModel& robot);
}  // namespace gpu_planning_scene
