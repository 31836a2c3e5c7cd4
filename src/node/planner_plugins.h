#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "gpu_planning_scene/planning/planner_factory.h"

namespace gpu_planning_scene::core
{
/// Planners of all packages that export some to pluginlib. Thread-safe.
class PlannerPlugins
{
 public:
  PlannerPlugins();
  ~PlannerPlugins();

  /// Debian's pluginlib looks for packages as ROS 1 does, but asks ROS 2's index first, and throws where no environment
  /// was set up for that. To be called before there are other threads.
  static void prepareEnvironment();

  /// The plugin of that name; it is loaded once. Throws Error that lists the names there are, and std::runtime_error
  /// for one that cannot be loaded.
  std::shared_ptr<const PlannerFactory> find(const std::string& name);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
