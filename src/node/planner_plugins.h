#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "gpu_planning_scene/planning/planner_factory.h"

namespace gpu_planning_scene
{
/// Planners of all packages that export some to pluginlib. Thread-safe.
class PlannerPlugins
{
 public:
  PlannerPlugins();
  ~PlannerPlugins();

  /// The plugin of that name; it is loaded once. Throws Error that lists the names there are.
  std::shared_ptr<const PlannerFactory> find(const std::string& name);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene
