#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

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

/// Two bodies and those of their shape instances that are nearest to each other.
struct NearBodies
{
  BodyPair bodies;  ///< the first is a body of the robot
  InstancePair instances;
  double clearance;  ///< metres beyond the required distance, as Clearance
};

/// Finds clearances of a state with the exact test of pairs. A pair is at most x beyond its required distance v if it
/// collides with the required distance v + x. `link_poses`: the pose of each link in the planning frame. Immutable.
class ClearanceSearch
{
 public:
  /// The problem must contain all pairs, also those that collide in every state. `objects` must be built over
  /// worldBounds().
  ClearanceSearch(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const CpuForest> forest,
                  std::shared_ptr<const ObjectTree> objects);

  /// The nearest pairs.
  NearestInstances find(const Eigen::Isometry3d* link_poses) const;

  /// All pairs of bodies that are nearer than `range`, ascending by their bodies.
  std::vector<NearBodies> pairsWithin(double range, const Eigen::Isometry3d* link_poses) const;

  /// For each body of the robot its nearest pair, if that is nearer than `range`; the first of the bodies ascends.
  std::vector<NearBodies> nearestOfBodies(double range, const Eigen::Isometry3d* link_poses) const;

 private:
  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  std::shared_ptr<const ObjectTree> objects_;
  std::vector<Eigen::AlignedBox3d> world_bounds_;  // boxes of the world's instances, without padding
};
}  // namespace gpu_planning_scene::core
