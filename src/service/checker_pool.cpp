#include "service/checker_pool.h"

#include <utility>

#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
CheckerPool::Lease::Lease(CheckerPool& pool, const std::shared_ptr<const PlanningScene>& scene, bool is_own)
  : pool_(pool)
{
  {
    const std::lock_guard<std::mutex> lock(pool_.mutex_);
    if (!pool_.idle_.empty())
    {
      checker_ = std::move(pool_.idle_.back());
      pool_.idle_.pop_back();
    }
  }
  if (is_own)
    asFaultOfService([&] { takeScene(scene); });
  else
    takeScene(scene);
}

void CheckerPool::Lease::takeScene(const std::shared_ptr<const PlanningScene>& scene)
{
  if (checker_)
    checker_->setScene(scene);
  else
    checker_ = pool_.make_(scene);
}

void CheckerPool::Lease::giveBack()
{
  const std::lock_guard<std::mutex> lock(pool_.mutex_);
  pool_.idle_.push_back(std::move(checker_));
}
}  // namespace gpu_planning_scene::core
