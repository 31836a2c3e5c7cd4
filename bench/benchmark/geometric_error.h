#pragma once

#include <memory>
#include <vector>

#include "collision/exact/exact_checker.h"
#include "support/fcl_peer.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core::benchmark
{
/// Measures the error of a wrong answer, in metres.
class GeometricError
{
 public:
  explicit GeometricError(const PlanningScene& scene);

  /// Whether the contract accepts both answers, because the state is very near to contact. Such a state is free with a
  /// distance of at most 1e-9 m above the required distance, or colliding with a penetration of about 1e-9 m at most.
  bool isOpen(const double* state, bool valid);

  /// For a free state that was reported as colliding: the smallest distance of a checked pair minus its required
  /// distance, computed by FCL; at most 1 m.
  double clearance(const double* state);

  /// For a colliding state that was reported as free: the penetration of the deepest pair. The exact checker finds the
  /// shortest separating translation along 26 directions. The result is an upper bound on the true penetration depth
  /// and little above it.
  double depth(const double* state);

 private:
  std::vector<Eigen::Isometry3d> posesOf(const double* state) const;

  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  ExactChecker exact_;
  ExactChecker::Scratch scratch_;
  FclPeer fcl_;
};
}  // namespace gpu_planning_scene::core::benchmark
