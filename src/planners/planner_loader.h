#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning/planner_factory.h"

namespace gpu_planning_scene::core
{
/// The planners that any package exports to pluginlib. Thread-safe.
class PlannerLoader
{
 public:
  PlannerLoader();
  ~PlannerLoader();

  /// Sets AMENT_PREFIX_PATH, unless it is set. Debian's pluginlib finds packages as ROS 1 does, but first looks into
  /// the index of ROS 2, and throws if that variable is not set. Call this before the start of other threads.
  static void prepareEnvironment();

  /// The plugin of that name. Each plugin is loaded once. Throws Error for an unknown name: the message suggests a
  /// similar name and lists the plugins and `configs`, the names of the configurations in ~planners. Throws
  /// std::runtime_error if the plugin cannot be loaded.
  std::shared_ptr<const PlannerFactory> find(const std::string& name, const std::vector<std::string>& configs);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
