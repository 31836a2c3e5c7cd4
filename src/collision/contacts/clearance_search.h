#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_forest.h"
#include "collision/exact/object_tree.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/state_inspector.h"

namespace gpu_planning_scene::core
{
/// How near a state is to a collision, by the exact test of pairs: a pair is at most x beyond its required distance v
/// if it collides where v + x is required. Immutable.
class ClearanceSearch
{
 public:
  /// The problem has all pairs, so also those that collide in every state. `objects`: over worldBounds().
  ClearanceSearch(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const CpuForest> forest,
                  std::shared_ptr<const ObjectTree> objects);

  /// `link_poses`: of every link, in the planning frame.
  Clearance find(const Eigen::Isometry3d* link_poses) const;

 private:
  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  std::shared_ptr<const ObjectTree> objects_;
  std::vector<Eigen::AlignedBox3d> world_bounds_;  // of its instances, without their padding
};

/// The least x in [low, high], to 1e-6 m and not above it, for which `holds`, which does for high, and for all above
/// the least.
template <class Predicate>
double leastFor(double low, double high, const Predicate& holds)
{
  constexpr double kResolution = 1e-6;  // metres
  while (high - low > kResolution)
  {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high)
      break;  // doubles as large as these have no micrometres
    (holds(middle) ? high : low) = middle;
  }
  return low;
}
}  // namespace gpu_planning_scene::core
