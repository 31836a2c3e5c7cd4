#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <moveit/planning_scene/planning_scene.h>
#include <moveit/robot_state/robot_state.h>

#include "gpu_planning_scene/planning_scene.h"
#include "moveit/planner/robot_conversion.h"

namespace gpu_planning_scene::pipeline
{
/// A scene of MoveIt as a scene of this package, with the start state as its current state.
struct ConvertedScene
{
  std::shared_ptr<const RobotConversion> robot;
  std::shared_ptr<const core::PlanningScene> scene;
};

/// Converts planning scenes for planning. A state that is free in the converted scene is free in MoveIt's scene too, by
/// the contract of this package: links with scale and padding, world objects, octrees, attached objects, and the
/// allowed collision matrix. A pair whose matrix entry has a decider is not allowed to collide. Keeps the converted
/// robot for later scenes. Thread-safe.
class SceneConverter
{
 public:
  /// `start`: with the attached objects. `workspace`: see RobotNeeds. Throws Refusal for a scene, and
  /// core::Error for a robot, that cannot be expressed exactly.
  ConvertedScene convert(const planning_scene::PlanningScene& scene, const moveit::core::RobotState& start,
                         const moveit::core::JointModelGroup& group,
                         const std::optional<Eigen::AlignedBox3d>& workspace);

 private:
  std::shared_ptr<const RobotConversion> robotFor(const moveit::core::RobotModelConstPtr& model,
                                                  const RobotNeeds& needs);

  std::mutex mutex_;
  std::shared_ptr<const RobotConversion> newest_;  // guarded by mutex_
};
}  // namespace gpu_planning_scene::pipeline
