#include "planners/planner_loader.h"

#include <cstdlib>
#include <stdexcept>

#include <pluginlib/class_loader.hpp>

#include "gpu_planning_scene/error.h"
#include "planners/unknown_planner.h"

namespace gpu_planning_scene::core
{
struct PlannerLoader::Impl
{
  using Loader = pluginlib::ClassLoader<PlannerFactory>;

  /// Makes the loader when a planner is first needed. The loader needs a package path in which rospack finds this
  /// package. A node that only checks states runs without one.
  Loader& theLoader()
  {
    if (!loader)
      loader = std::make_unique<Loader>("gpu_planning_scene", "gpu_planning_scene::core::PlannerFactory");
    return *loader;
  }

  std::mutex mutex;
  std::unique_ptr<Loader> loader;
  std::map<std::string, std::shared_ptr<const PlannerFactory>> loaded;  // destroyed before the loader of its libraries
};

PlannerLoader::PlannerLoader() : impl_(std::make_unique<Impl>()) {}

void PlannerLoader::prepareEnvironment()
{
  setenv("AMENT_PREFIX_PATH", "/usr", 0);
}

PlannerLoader::~PlannerLoader() = default;

std::shared_ptr<const PlannerFactory> PlannerLoader::find(const std::string& name,
                                                          const std::vector<std::string>& configs)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  const auto known = impl_->loaded.find(name);
  if (known != impl_->loaded.end())
    return known->second;
  try
  {
    Impl::Loader& loader = impl_->theLoader();
    if (!loader.isClassAvailable(name))
      throw Error(unknownPlannerText(name, configs, loader.getDeclaredClasses()));
    const boost::shared_ptr<PlannerFactory> made = loader.createInstance(name);
    const std::shared_ptr<const PlannerFactory> factory(made.get(), [made](const PlannerFactory*) {});
    return impl_->loaded.emplace(name, factory).first->second;
  }
  catch (const pluginlib::PluginlibException& error)
  {
    throw std::runtime_error("planner '" + name + "' cannot be loaded: " + error.what());
  }
}
}  // namespace gpu_planning_scene::core
