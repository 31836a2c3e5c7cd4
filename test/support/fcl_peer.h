#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "collision/problem/collision_problem.h"
#include "support/fcl_trees.h"

namespace gpu_planning_scene::core
{
/// The order in which pairs are checked until the first collision is found.
enum class FclOrder
{
  Fixed,   ///< the world before the robot itself; the bounding boxes of all pairs are tested
  Learned  ///< as ExactChecker: checks with most collisions for their cost first; FCL's broad phase for the world
};

/// FCL 0.7 as the peer of tests and benchmarks. Meshes and boxes are BVHModels; spheres, cylinders and cones are FCL's
/// shapes. The bounding boxes of a pair are tested first. Contacts are on, and a query ends at the first contact.
/// Padded pairs are checked by FCL's distances, up to the padding. Not thread-safe: one per thread.
class FclPeer
{
 public:
  /// Throws Error for a problem with half-spaces. Throws Error for a problem with padding if FCL computes no distances
  /// for this kind of tree.
  explicit FclPeer(std::shared_ptr<const CollisionProblem> problem, FclTree tree = FclTree::Obbrss,
                   FclOrder order = FclOrder::Fixed);
  /// The copy shares the data that queries do not change.
  FclPeer(const FclPeer& other);
  ~FclPeer();
  FclPeer& operator=(const FclPeer&) = delete;

  /// Sets the poses of all links, in the planning frame, for the following calls.
  void setState(const Eigen::Isometry3d* link_poses);

  std::optional<BodyPair> firstCollision();

  /// The first pair whose distance, by FCL, is at most its required distance plus its margin. `margins`: as for
  /// ExactChecker. The order must be FclOrder::Learned.
  std::optional<BodyPair> firstNear(const double* margins);

  /// All pairs of bodies that collide.
  std::vector<BodyPair> allCollisions() const;

  /// Whether a pair of bodies, in either order, is checked and collides.
  bool collides(const BodyPair& pair) const;

  /// Whether a pair of bodies is free when it is moved 1e-6 m apart in one of seven directions.
  bool freeWhenMovedApart(const BodyPair& pair) const;

  /// Whether the distance of a pair of bodies is at most `distance`, by FCL.
  bool within(const BodyPair& pair, double distance) const;

  /// The smallest value of distance minus padding over all checked pairs if it is below `limit`; else `limit`.
  double clearance(double limit) const;

  /// The distance of each pair of bodies, with one call of FCL for each checked pair of shapes. The bodies ascend.
  std::map<BodyPair, double> distances() const;

  /// Whether a body of the pair has a vertex inside a solid of the other body. For primitives this is computed
  /// directly, for meshes by the parity of ray crossings.
  bool oneInsideTheOther(const BodyPair& pair) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
