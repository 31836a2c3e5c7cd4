#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/exact_checker.h"
#include "collision/problem/collision_problem.h"
#include "collision/trees/cpu_forest.h"
#include "collision/trees/object_tree.h"
#include "gpu_planning_scene/state_inspector.h"

namespace gpu_planning_scene::core
{
/// The clearance of a state, and the shape instances that are nearest to each other. An instance pair is set only if
/// the clearance has a pair of bodies.
struct NearestInstances
{
  Clearance clearance;
  InstancePair world = {};
  InstancePair self = {};
};

/// Finds the clearance of a state with the exact test of pairs. A pair is at most x beyond its required distance v if
/// it collides with the required distance v + x. Immutable.
class ClearanceSearch
{
 public:
  /// The problem must contain all pairs, also those that collide in every state. `objects` must be built over
  /// worldBounds().
  ClearanceSearch(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const CpuForest> forest,
                  std::shared_ptr<const ObjectTree> objects);

  /// `link_poses`: the pose of each link in the planning frame.
  NearestInstances find(const Eigen::Isometry3d* link_poses) const;

 private:
  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  std::shared_ptr<const ObjectTree> objects_;
  std::vector<Eigen::AlignedBox3d> world_bounds_;  // boxes of the world's instances, without padding
};
}  // namespace gpu_planning_scene::core
