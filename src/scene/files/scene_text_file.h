#pragma once

#include <memory>
#include <string>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Reads a .scene file, as RViz's MotionPlanning plugin writes it. Throws Error with file and line. The file holds:
/// - a line with the name of the scene;
/// - for each object: a line "* NAME"; its pose (not in older files); the number of its shapes; for each shape its kind
///   and dimensions, its pose and its colour (0 0 0 0: none); the number of its subframes (not in older files); for
///   each subframe its name and pose;
/// - a "." at the end.
/// A pose is "x y z" and "x y z w" (a quaternion).
PlanningScene loadSceneTextFile(const std::string& path, std::shared_ptr<const RobotModel> robot,
                                const SceneDefaults& defaults);

/// Reads the text of a .scene file. `file` is the name for messages.
PlanningScene readSceneText(const std::string& text, const std::string& file, std::shared_ptr<const RobotModel> robot,
                            const SceneDefaults& defaults);
}  // namespace gpu_planning_scene::core
