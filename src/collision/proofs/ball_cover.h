#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "collision/proofs/shape_samples.h"
#include "collision/trees/cpu_tree.h"

namespace gpu_planning_scene::core
{
/// A ball of a cover, in the frame of the shape, in metres.
struct CoverBall
{
  Eigen::Vector3d center;
  double outer;             ///< the ball of this radius around the centre contains its part of the shape
  Eigen::Vector3d witness;  ///< a point of the shape: the centre if it is inside, otherwise a point of the surface
  double inner;             ///< the ball of this radius around the witness is inside the shape; at least 0
};

/// The number of balls of each level of a cover.
constexpr std::array<std::size_t, 3> kCoverBalls = {1, 8, 32};

/// Balls that enclose and fill a shape, on several levels. One distance between two balls proves either verdict: if the
/// outer balls of two shapes are apart, the shapes are apart; if two inner balls overlap, the shapes collide. Outer and
/// inscribed balls with a common centre: Weller and Zachmann, "Inner sphere trees", 2009; the choice of the balls is a
/// greedy set cover as in Wang et al., "Variational sphere set approximation", 2006, without their optimisation.
struct BallCover
{
  /// A level may have fewer balls than kCoverBalls; each has at least one.
  std::array<std::vector<CoverBall>, kCoverBalls.size()> levels;
  /// Metres. The balls of levels 1 and 2 may leave a layer of the solid uncovered. The layer lies below the surface and
  /// is at most this deep. Level 0 contains the whole shape. 0 for shapes without a solid.
  double layer = 0.0;
  /// Metres: each component of the shape contains a ball of this radius. 0: unknown.
  double thickness = 0.0;
};

/// The cover of a tree's shape. `samples`: of the tree; `sagitta`: see Tessellation. Takes about 0.2 s. Throws
/// ProofsStopped.
BallCover coverOf(const CpuTree& tree, const ShapeSamples& samples, double sagitta, const Stopped& stopped = {});
}  // namespace gpu_planning_scene::core
