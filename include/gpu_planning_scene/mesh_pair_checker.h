#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/batch_checker_options.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Checks two rigid shapes in many relative poses, without a robot. This is the experiment of A. Gress, G. Zachmann:
/// Object-Space Interference Detection on Programmable Graphics Hardware (2003). Thread-safe: calls are served one
/// after the other.
class MeshPairChecker
{
 public:
  /// Throws Error as BatchChecker does, and also if a shape is not valid or `b` is a half-space.
  MeshPairChecker(const Shape& a, const Shape& b, const BatchCheckerOptions& options);
  ~MeshPairChecker();

  /// Returns one byte per pose: 1 if `b`, placed at the pose in the frame of `a`, collides with `a`, else 0. Throws
  /// Error if a pose is not finite or not a rigid motion.
  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a);

  /// Wall time of the last call in seconds, and the number of its poses that the CPU decided.
  double seconds() const;
  std::size_t undecided() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
