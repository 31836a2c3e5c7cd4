#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "collision/exact/cpu_shape_pair.h"
#include "collision/problem/collision_problem.h"
#include "collision/trees/cpu_forest.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The result of a proof attempt. A collision that was found holds for certain, too.
enum class Separation
{
  Apart,    ///< the bodies never collide while all joints are within their limits
  Meet,     ///< they collide in a state within the limits
  Unknown,  ///< neither was found within the allowed number of tests
};

/// Tries to prove for pairs of robot instances that they never collide, for all joint values within the limits and up
/// to a little beyond them. One object per thread.
class SeparationProver
{
 public:
  /// `forest`: the trees of the problem. Both must outlive the prover.
  SeparationProver(std::shared_ptr<const RobotModel> robot, const CollisionProblem& problem,
                   std::shared_ptr<const CpuForest> forest);

  /// `most_tests`: at most so many boxes of joint values are tested. Pairs with a planar or floating joint between
  /// them, or with a joint without usable limits, give Unknown.
  Separation prove(const InstancePair& pair, std::size_t most_tests);

 private:
  struct Chain;

  Separation test(const Chain& chain, const double* box, std::size_t& widest);

  std::shared_ptr<const RobotModel> robot_;
  const CollisionProblem& problem_;
  std::shared_ptr<const CpuForest> forest_;
  CpuShapePair pairs_;
  CpuShapePair::Scratch scratch_;
  std::vector<double> state_;
  std::vector<Eigen::Isometry3d> poses_;
};
}  // namespace gpu_planning_scene::core
