#include "gpu_planning_scene/planning/known_paths.h"

#include <algorithm>
#include <utility>

#include <ompl/base/ScopedState.h>

namespace gpu_planning_scene::core
{
namespace
{
// By the distance of the space: measured starts and the goals of inverse kinematics are never quite equal.
constexpr double kSameState = 1e-3;

/// Compares rows of the variables of a space.
class RowComparison
{
 public:
  explicit RowComparison(const ompl::base::StateSpacePtr& space)
    : space_(*space->as<GroupStateSpace>()), row_(space_.robot()->variables().size()), first_(space), second_(space)
  {
  }

  bool haveSameEnds(const KnownPaths::Path& a, const KnownPaths::Path& b)
  {
    return (areSame(a.front(), b.front()) && areSame(a.back(), b.back())) ||
           (areSame(a.front(), b.back()) && areSame(a.back(), b.front()));
  }

 private:
  bool areSame(const std::vector<double>& a, const std::vector<double>& b)
  {
    copy(a, first_.get());
    copy(b, second_.get());
    return space_.distance(first_.get(), second_.get()) <= kSameState;
  }

  void copy(const std::vector<double>& values, ompl::base::State* state)
  {
    for (std::size_t i = 0; i < values.size(); ++i)
      row_[static_cast<std::size_t>(space_.variables()[i])] = values[i];
    space_.copyFromRow(row_.data(), state);
  }

  const GroupStateSpace& space_;
  std::vector<double> row_;  // of all variables of the robot
  ompl::base::ScopedState<> first_;
  ompl::base::ScopedState<> second_;
};
}  // namespace

void KnownPaths::add(const std::shared_ptr<GroupStateSpace>& space, const std::vector<std::vector<double>>& waypoints)
{
  if (capacity_ == 0 || waypoints.size() < 3)
    return;
  Path path;
  for (const std::vector<double>& row : waypoints)
  {
    path.emplace_back();
    for (const int variable : space->variables())
      path.back().push_back(row[static_cast<std::size_t>(variable)]);
  }
  RowComparison comparison(space);
  const std::lock_guard<std::mutex> lock(mutex_);
  Paths& paths = by_group_[space->group().name];
  paths.erase(std::remove_if(paths.begin(), paths.end(),
                             [&](const auto& known)
                             {
                               const bool is_of_another_robot = known->front().size() != path.front().size();
                               return is_of_another_robot || comparison.haveSameEnds(*known, path);
                             }),
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
