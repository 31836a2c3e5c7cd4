#include "node/planner_plugins.h"

#include <cstdlib>

#include <pluginlib/class_loader.hpp>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
struct PlannerPlugins::Impl
{
  std::mutex mutex;
  pluginlib::ClassLoader<PlannerFactory> loader{"gpu_planning_scene", "gpu_planning_scene::PlannerFactory"};
  std::map<std::string, std::shared_ptr<const PlannerFactory>> loaded;  // before the loader: they end first
};

/// Debian's pluginlib looks for packages as ROS 1 does, but asks ROS 2's index first, and throws where no environment
/// was set up for that.
PlannerPlugins::PlannerPlugins()
{
  setenv("AMENT_PREFIX_PATH", "/usr", 0);
  impl_ = std::make_unique<Impl>();
}

PlannerPlugins::~PlannerPlugins() = default;

std::shared_ptr<const PlannerFactory> PlannerPlugins::find(const std::string& name)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  const auto known = impl_->loaded.find(name);
  if (known != impl_->loaded.end())
    return known->second;
  if (!impl_->loader.isClassAvailable(name))
  {
    std::string all;
    for (const std::string& one : impl_->loader.getDeclaredClasses())
      all += (all.empty() ? "" : ", ") + one;
    throw Error("there is no planner '" + name + "', neither in planners.yaml nor as a plugin; plugins: " + all);
  }
  try
  {
    const boost::shared_ptr<PlannerFactory> made = impl_->loader.createInstance(name);
    const std::shared_ptr<const PlannerFactory> factory(made.get(), [made](const PlannerFactory*) {});
    return impl_->loaded.emplace(name, factory).first->second;
  }
  catch (const pluginlib::PluginlibException& error)
  {
    throw Error("planner '" + name + "' cannot be loaded: " + error.what());
  }
}
}  // namespace gpu_planning_scene
