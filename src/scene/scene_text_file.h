#pragma once

#include <memory>
#include <string>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A .scene file, as RViz's MotionPlanning plugin writes it: a line with the scene's name; for each object a line
/// "* NAME", its pose (not in older files), the number of shapes; for each shape its kind and dimensions, pose and
/// colour (0 0 0 0: none); the number of subframes (not in older files), their names and poses; "." ends it.
/// Poses are "x y z" and "x y z w". Throws Error with file and line.
PlanningScene loadSceneTextFile(const std::string& path, std::shared_ptr<const RobotModel> robot,
                                const SceneDefaults& defaults);

/// The same of its text; `file` is the name for messages.
PlanningScene readSceneText(const std::string& text, const std::string& file, std::shared_ptr<const RobotModel> robot,
                            const SceneDefaults& defaults);
}  // namespace gpu_planning_scene::core
