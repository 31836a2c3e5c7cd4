#include "collision/contacts/convex_trees.h"

#include "collision/contacts/contact_shape.h"

// The test of a mesh visits each of its triangles, so its answer is kept.
namespace gpu_planning_scene::core
{
bool KnownConvexity::isConvex(const std::shared_ptr<const CpuTree>& tree)
{
  if (!tree->mesh)
    return true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = convex_.find(tree);
    if (known != convex_.end())
      return known->second;
  }
  const bool is_convex = isConvexSolid(*tree);
  const std::lock_guard<std::mutex> lock(mutex_);
  return convex_[tree] = is_convex;
}

void KnownConvexity::forgetUnused()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto entry = convex_.begin(); entry != convex_.end();)
    entry = entry->first.expired() ? convex_.erase(entry) : std::next(entry);
}

bool ConvexTrees::isConvex(std::uint32_t tree) const
{
  const Answer known = answers_[tree].load(std::memory_order_relaxed);
  if (known != Answer::Unknown)
    return known == Answer::Convex;
  const bool is_convex = known_->isConvex(forest_->shared(tree));
  answers_[tree].store(is_convex ? Answer::Convex : Answer::NotConvex, std::memory_order_relaxed);
  return is_convex;
}
}  // namespace gpu_planning_scene::core
