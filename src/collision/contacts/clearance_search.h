#pragma once

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/contacts/convex_trees.h"
#include "collision/problem/collision_problem.h"
#include "collision/trees/cpu_forest.h"
#include "collision/trees/object_tree.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Two bodies that are near to each other.
struct NearBodies
{
  BodyPair bodies = kNoPair;                                   ///< the first is a body of the robot
  double clearance = std::numeric_limits<double>::infinity();  ///< metres beyond the required distance, as Clearance
  bool collides = false;
  /// The nearest points of the surfaces without padding, in the order of the bodies and in the planning frame; NaN if
  /// the bodies collide.
  std::array<Eigen::Vector3d, 2> points = {Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()),
                                           Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};

  /// The clearance; below 0 if the bodies collide, so that a collision is nearer than a clearance that rounds to 0.
  double order() const { return collides ? -1.0 : clearance; }
};

/// The nearest pairs of a state; without bodies if no pair is checked.
struct NearestOfState
{
  NearBodies world;
  NearBodies self;
};

/// Finds clearances of a state with the exact test of pairs. A pair is at most x beyond its required distance v if it
/// collides with the required distance v + x. `link_poses`: the pose of each link in the planning frame. Immutable.
class ClearanceSearch
{
 public:
  /// The problem must contain all pairs, also those that collide in every state. `objects` must be built over
  /// worldBounds(). `convex` must outlive the search.
  ClearanceSearch(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const CpuForest> forest,
                  std::shared_ptr<const ObjectTree> objects, const ConvexTrees& convex);

  NearestOfState find(const Eigen::Isometry3d* link_poses) const;

  /// All pairs of bodies that are nearer than `range`, ascending by their bodies.
  std::vector<NearBodies> pairsWithin(double range, const Eigen::Isometry3d* link_poses) const;

  /// For each body of the robot its nearest pair, if that is nearer than `range`; the first of the bodies ascends.
  std::vector<NearBodies> nearestOfBodies(double range, const Eigen::Isometry3d* link_poses) const;

 private:
  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  std::shared_ptr<const ObjectTree> objects_;
  const ConvexTrees& convex_;
  std::vector<Eigen::AlignedBox3d> world_bounds_;  // boxes of the world's instances, without padding
};
}  // namespace gpu_planning_scene::core
