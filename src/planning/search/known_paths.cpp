#include "gpu_planning_scene/planning/known_paths.h"

#include <algorithm>
#include <utility>

namespace gpu_planning_scene::core
{
namespace
{
bool haveSameEnds(const KnownPaths::Path& a, const KnownPaths::Path& b)
{
  return (a.front() == b.front() && a.back() == b.back()) || (a.front() == b.back() && a.back() == b.front());
}
}  // namespace

void KnownPaths::add(const std::string& group, Path path)
{
  if (capacity_ == 0 || path.size() < 2)
    return;
  const std::lock_guard<std::mutex> lock(mutex_);
  Paths& paths = by_group_[group];
  paths.erase(
      std::remove_if(paths.begin(), paths.end(), [&path](const auto& known) { return haveSameEnds(*known, path); }),
      paths.end());
  paths.insert(paths.begin(), std::make_shared<const Path>(std::move(path)));
  paths.resize(std::min(paths.size(), capacity_));
}

std::vector<std::shared_ptr<const KnownPaths::Path>> KnownPaths::of(const std::string& group) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = by_group_.find(group);
  return found == by_group_.end() ? Paths() : found->second;
}

TriesKnownPaths::~TriesKnownPaths() = default;
}  // namespace gpu_planning_scene::core
