#include "support/checkers.h"

#include <map>
#include <memory>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"

namespace gpu_planning_scene::core
{
StateChecker& checkerOf(const std::string& name, const PlanningScene& scene)
{
  static std::map<std::string, std::unique_ptr<StateChecker>> made;
  auto shared = std::make_shared<const PlanningScene>(scene);
  std::unique_ptr<StateChecker>& checker = made[name];
  if (checker)
  {
    checker->setScene(std::move(shared));
  }
  else if (name == "cpu")
  {
    checker = std::make_unique<CpuChecker>(std::move(shared));
  }
  else
  {
    BatchCheckerOptions options;
    options.traversal = traversalFromName(name);
    options.device_only = true;
    checker = std::make_unique<BatchChecker>(std::move(shared), options);
  }
  return *checker;
}
}  // namespace gpu_planning_scene::core
