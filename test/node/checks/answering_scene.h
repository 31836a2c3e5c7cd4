#pragma once

#include <memory>
#include <utility>

#include "gpu_planning_scene/cpu_checker.h"
#include "node/checks/check_services.h"

namespace gpu_planning_scene::core
{
/// A scene and the services that answer in it, without a ROS master.
struct AnsweringScene
{
  explicit AnsweringScene(PlanningScene scene, std::size_t max_motion_checks = 1000000, OtherFrames others = {})
    : store(std::move(scene), {}, {}),
      services(store, server, memory, {100000, max_motion_checks, 10}, std::move(others))
  {
  }

  SceneStore store;
  CheckServer server{store,
                     [](std::shared_ptr<const PlanningScene> scene)
                     { return std::make_shared<CpuChecker>(std::move(scene)); },
                     {}};
  MemoryGuard memory{0};
  CheckServices services;
};
}  // namespace gpu_planning_scene::core
