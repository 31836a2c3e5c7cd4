#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/group_state_space.h"

namespace gpu_planning_scene::core
{
/// The last paths that were found for each group of a robot. Robots repeat their ways, so a planner tries them first
/// (PlanningQuery::known_paths). A known path is only a proposal: each plan checks its motions in its own scene.
/// Thread-safe.
///
/// D. Berenson, P. Abbeel, K. Goldberg: A robot path planning framework that learns from experience. ICRA 2012.
class KnownPaths
{
 public:
  /// The waypoints of a path: rows of GroupStateSpace::variables(), in radians and metres.
  using Path = std::vector<std::vector<double>>;

  /// Keeps at most `capacity` paths of each group; 0: none.
  explicit KnownPaths(std::size_t capacity) : capacity_(capacity) {}

  /// Adds the waypoints of a path of the space's group: rows with one value per variable of the robot. A straight
  /// motion is not kept, because a planner tries it anyway. The path replaces one between the same two states (to
  /// 1e-3, by the distance of the space), in either direction. If there are too many paths, the oldest one goes.
  /// Paths with another number of variables, of another robot, go too.
  void add(const std::shared_ptr<GroupStateSpace>& space, const std::vector<std::vector<double>>& waypoints);

  /// The paths of a group, the newest first.
  std::vector<std::shared_ptr<const Path>> of(const std::string& group) const;

 private:
  using Paths = std::vector<std::shared_ptr<const Path>>;

  const std::size_t capacity_;
  mutable std::mutex mutex_;  // guards the map
  std::map<std::string, Paths> by_group_;
};

/// The interface of planners that try known paths first: BatchRrtConnect and AnytimeBatch.
class TriesKnownPaths
{
 public:
  virtual ~TriesKnownPaths();

  /// The next search tries these paths once, in both directions. They need not begin at a start or end at a goal, and
  /// their motions need not be valid.
  virtual void setKnownPaths(std::vector<ompl::geometric::PathGeometric> paths) = 0;
};
}  // namespace gpu_planning_scene::core
