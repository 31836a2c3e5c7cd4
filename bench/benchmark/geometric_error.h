#pragma once

#include <memory>
#include <vector>

#include "collision/exact/cpu_traversal.h"
#include "support/fcl_peer.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core::benchmark
{
/// How far from the truth a wrong answer is, in metres.
class GeometricError
{
 public:
  explicit GeometricError(const PlanningScene& scene);

  /// Whether a state is so near to contact that the contract leaves its answer open: free with a distance of at most
  /// 1e-9 m above the required one, or colliding by about as little.
  bool isOpen(const double* state, bool valid);

  /// Of a free state that was called colliding: the least distance of a checked pair, less its required distance, by
  /// FCL; at most 1 m.
  double clearance(const double* state);

  /// Of a colliding state that was called free: how far the deepest pair has to be moved apart, by the exact checker,
  /// along the best of 26 directions. The true depth is at most that, and not much less.
  double depth(const double* state);

 private:
  std::vector<Eigen::Isometry3d> posesOf(const double* state) const;

  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  CpuTraversal exact_;
  CpuTraversal::Scratch scratch_;
  FclPeer fcl_;
};
}  // namespace gpu_planning_scene::core::benchmark
