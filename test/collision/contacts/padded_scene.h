#pragma once

#include <string>

#include "support/obstacles.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
/// The scene with more objects, which are padded, a floor, and padded links.
inline PlanningScene paddedScene(const TestScene& test)
{
  PlanningScene made = *test.scene;
  for (const WorldObject& object : generateObstacles({12, Eigen::Vector3d(0, 0, 0.5), 0.9, 1.5, 0.3}, 5))
  {
    made.objects.push_back(object);
    made.objects.back().id = "more " + std::to_string(made.objects.size());
    made.objects.back().padding = 0.004;
  }
  made.objects.push_back({"floor", Eigen::Isometry3d::Identity(), {{HalfSpace{Eigen::Vector3d::UnitZ(), -0.2}}}});
  made.link_padding.assign(made.robot->links().size(), 0.006);
  return made;
}
}  // namespace gpu_planning_scene::core
