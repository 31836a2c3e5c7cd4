#include "service/checker_pool.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
CheckerPool::Lease::Lease(CheckerPool& pool, const std::shared_ptr<const PlanningScene>& scene, bool is_own)
  : pool_(pool)
{
  {
    const std::lock_guard<std::mutex> lock(pool_.mutex_);
    std::vector<Kept>& idle = pool_.idle_;
    if (!idle.empty())
    {
      const auto has_scene =
          std::find_if(idle.rbegin(), idle.rend(), [&scene](const Kept& kept) { return kept.scene == scene; });
      const auto taken = has_scene != idle.rend() ? std::prev(has_scene.base()) : idle.begin();
      kept_ = std::move(*taken);
      idle.erase(taken);
    }
  }
  if (is_own)
    asFaultOfService([&] { takeScene(scene); });
  else
    takeScene(scene);
}

void CheckerPool::Lease::takeScene(const std::shared_ptr<const PlanningScene>& scene)
{
  if (!kept_.checker)
    kept_.checker = pool_.make_(scene);
  else if (kept_.scene != scene)
    kept_.checker->setScene(scene);
  kept_.scene = scene;
}

void CheckerPool::Lease::giveBack()
{
  if (!kept_.checker)
    return;  // it is given back already
  const std::lock_guard<std::mutex> lock(pool_.mutex_);
  pool_.idle_.push_back(std::move(kept_));
  kept_ = {};
}
}  // namespace gpu_planning_scene::core
