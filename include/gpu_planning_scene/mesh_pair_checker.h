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
/// Two rigid shapes in many relative poses, without a robot: the experiment of Gress and Zachmann, "Object-Space
/// Interference Detection on Programmable Graphics Hardware" (2003). Thread-safe: calls are served one after the other.
class MeshPairChecker
{
 public:
  /// Throws Error as BatchChecker does, for a shape that is not valid, and where b is a half-space.
  MeshPairChecker(const Shape& a, const Shape& b, const BatchCheckerOptions& options);
  ~MeshPairChecker();

  /// One byte a pose: 1 if b, placed by the pose in a's frame, meets a; 0 if they are apart. Throws Error for a pose
  /// that is not finite or not a rigid motion.
  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a);

  /// How long the last call took, and how many of its poses the CPU had to settle.
  double seconds() const;
  std::size_t undecided() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
