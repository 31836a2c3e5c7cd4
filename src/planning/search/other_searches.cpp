#include "planning/search/other_searches.h"

#include <algorithm>

namespace gpu_planning_scene::core
{
void OtherSearches::start(std::size_t count, const Round& round)
{
  paths_.resize(count);
  errors_.resize(count);
  const auto run = [this, round](std::size_t search)
  {
    try
    {
      while (!paths_[search] && !has_ended_)
        paths_[search] = round(search, end_);
    }
    catch (...)
    {
      errors_[search] = std::current_exception();
    }
    has_ended_ = true;
  };
  try
  {
    for (std::size_t search = 1; search < count; ++search)
      threads_.emplace_back([run, search] { run(search); });
  }
  catch (const std::exception&)
  {
    // No thread, or no memory for one. The searches that have begun go on.
  }
}

void OtherSearches::end()
{
  has_ended_ = true;
  threads_.clear();
}

OtherSearches::Solution OtherSearches::solution() const
{
  for (const std::exception_ptr& error : errors_)
    if (error)
      std::rethrow_exception(error);
  const auto found = std::find_if(paths_.begin(), paths_.end(), [](const auto& path) { return path != nullptr; });
  return found == paths_.end() ? Solution() : Solution{static_cast<std::size_t>(found - paths_.begin()), *found};
}
}  // namespace gpu_planning_scene::core
