#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "collision/contacts/fcl_models.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// In which order pairs are looked at for a first collision.
enum class FclOrder
{
  Fixed,   ///< the world before the robot itself; the boxes of all pairs
  Learned  ///< as CpuTraversal: what found most collisions for its cost comes first; FCL's broad phase for the world
};

/// FCL 0.7 as the peer of tests and benchmarks: meshes and boxes as BVHModel, spheres, cylinders and cones as FCL's
/// shapes, contacts on, the boxes of a pair tested first, the end at the first contact. Padded pairs by its distances,
/// up to the padding. Not thread-safe: one per thread.
class FclPeer
{
 public:
  /// Throws Error for a problem with half-spaces, and for one with padding unless the tree knows distances.
  explicit FclPeer(std::shared_ptr<const CollisionProblem> problem, FclTree tree = FclTree::Obbrss,
                   FclOrder order = FclOrder::Fixed);
  /// Shares what queries do not change.
  FclPeer(const FclPeer& other);
  ~FclPeer();
  FclPeer& operator=(const FclPeer&) = delete;

  /// The poses that all further calls are about: of every link, in the planning frame.
  void setState(const Eigen::Isometry3d* link_poses);

  std::optional<BodyPair> firstCollision();

  /// The same with margins as CpuTraversal's, by FCL's distances; the order must be learned.
  std::optional<BodyPair> firstNear(const double* margins);

  /// All pairs of bodies that collide.
  std::vector<BodyPair> allCollisions() const;

  /// Whether a pair of bodies, in either order, is checked and collides.
  bool collides(const BodyPair& pair) const;

  /// Whether a pair of bodies is free when it is moved 1e-6 m apart, in one of seven directions.
  bool freeWhenMovedApart(const BodyPair& pair) const;

  /// Whether the distance of a pair of bodies is at most `distance`, by FCL.
  bool within(const BodyPair& pair, double distance) const;

  /// The least, over all checked pairs, of distance less padding, if it is below `limit`; else `limit`.
  double clearance(double limit) const;

  /// Whether one body of a pair has a vertex in a solid of the other: in a primitive, or in a mesh by the parity of the
  /// crossings of rays.
  bool oneInsideTheOther(const BodyPair& pair) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
