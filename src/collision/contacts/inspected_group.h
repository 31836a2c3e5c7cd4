#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/bounds/problem_maker.h"
#include "collision/contacts/body_contacts.h"
#include "collision/contacts/body_pairs.h"
#include "collision/contacts/clearance_search.h"
#include "collision/contacts/convex_trees.h"
#include "collision/exact/exact_checker.h"
#include "collision/exact/forest_cache.h"
#include "gpu_planning_scene/state_inspector.h"

namespace gpu_planning_scene::core
{
/// Trees of shapes. Scenes that have the same shapes share them. Thread-safe.
class InspectionTrees
{
 public:
  /// The trees of one group of a scene.
  struct Prepared
  {
    std::shared_ptr<const CollisionProblem> problem;
    std::shared_ptr<const CpuForest> forest;
    std::shared_ptr<const ObjectTree> objects;
    std::unique_ptr<const ExactChecker> exact;
  };

  Prepared prepare(const PlanningScene& scene, const std::string& group);

  const std::shared_ptr<KnownConvexity>& convexity() const { return convexity_; }

 private:
  std::mutex mutex_;  // guards `maker_` and `forests_`
  ProblemMaker maker_{optionsWithAllPairs()};
  ForestCache forests_;
  std::shared_ptr<KnownConvexity> convexity_ = std::make_shared<KnownConvexity>();
};

/// Two bodies that collide.
struct CollidingPair
{
  BodyPair bodies;                      ///< ascending
  std::vector<InstancePair> instances;  ///< those that collide
  std::vector<Contact> contacts;        ///< at least one; the deepest first
};

/// Contacts, clearances and nearest points of the pairs that one group of a scene moves. `link_poses`: one per link, in
/// the planning frame. Thread-safe.
class InspectedGroup
{
 public:
  InspectedGroup(const PlanningScene& scene, const std::string& group, InspectionTrees& trees);

  InspectedGroup(const InspectedGroup&) = delete;
  InspectedGroup& operator=(const InspectedGroup&) = delete;

  const ClearanceSearch& clearance() const { return clearance_; }
  const CollisionProblem& problem() const { return *prepared_.problem; }

  /// The link that carries a body of the robot; -1 for an object of the world.
  int linkOf(std::int32_t body) const;

  /// The pairs of bodies that collide, ascending, each with at most `most` contacts. `most` is not 0.
  std::vector<CollidingPair> collidingPairs(const std::vector<Eigen::Isometry3d>& link_poses, std::size_t most) const;

  /// No translation of at most this length separates the bodies, in metres; 0: no such length is known.
  double leastDepth(const CollidingPair& pair, const std::vector<Eigen::Isometry3d>& link_poses) const;

 private:
  ContactShape shapeOf(std::size_t instance, const std::vector<Eigen::Isometry3d>& link_poses) const;
  ShapeContact contactOfHalfSpace(const InstancePair& pair, const std::vector<Eigen::Isometry3d>& link_poses) const;
  std::vector<Contact> contactsOfBodies(const BodyPair& bodies, const std::vector<InstancePair>& colliding,
                                        const std::vector<Eigen::Isometry3d>& link_poses, std::size_t most) const;
  std::vector<ShapeContact> contactsOfShapes(const BodyPair& bodies, const std::vector<InstancePair>& colliding,
                                             const std::vector<Eigen::Isometry3d>& link_poses, std::size_t most) const;

  InspectionTrees::Prepared prepared_;
  ConvexTrees convex_;
  ClearanceSearch clearance_;
  BodyPairs pairs_;
  std::map<std::int32_t, int> links_;  // of the robot's bodies
  std::uint32_t first_half_space_;     // of the second index of an instance pair
};
}  // namespace gpu_planning_scene::core
