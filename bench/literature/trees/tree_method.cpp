#include "literature/trees/tree_method.h"

namespace gpu_planning_scene::core::literature
{
TreeMethod::TreeMethod(const std::vector<Triangle>& a, const std::vector<Triangle>& b, Search search)
  : a_(a), b_(b), search_(search)
{
}

bool TreeMethod::collides(const Eigen::Isometry3d& b_in_a)
{
  pose_ = b_in_a;
  pairs_.clear();
  const bool ended = traverse();
  pairs_found_ += static_cast<double>(pairs_.size());
  return ended || !pairs_.empty();
}

bool TreeMethod::testLeaves(std::uint32_t a, std::uint32_t b)
{
  ++triangle_tests_;
  if (!trianglesOverlap(a_[a], moved(b_[b], pose_.linear(), pose_.translation())))
    return false;
  if (search_ == Search::First)
    return true;
  pairs_.push_back({a, b});
  return false;
}

WorkCounts TreeMethod::work() const
{
  WorkCounts counts = {{"volume tests", volume_tests_}, {"triangle tests", triangle_tests_}};
  if (search_ == Search::All)
    counts.emplace_back("pairs of triangles", pairs_found_);
  return counts;
}
}  // namespace gpu_planning_scene::core::literature
