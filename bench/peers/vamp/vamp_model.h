#pragma once

#include <memory>

#include "gpu_planning_scene/planning_scene.h"
#include "peers/vamp/vamp_pairs.h"

namespace gpu_planning_scene::core::benchmark
{
/// VAMP's sphere model of the ur5 for our checkers: its spheres as links, and its pairs of links.
struct VampModel
{
  std::shared_ptr<const RobotModel> robot;
  LinkPairs pairs;
};

/// Throws Error if a file is missing, or if the variables of the model are not those of `robot`.
VampModel loadVampModel(const RobotModel& robot);

/// VAMP's spheres and pairs in a scene with its true objects. All links are checked against all objects.
PlanningScene withSpheres(const PlanningScene& scene, const VampModel& model);
}  // namespace gpu_planning_scene::core::benchmark
