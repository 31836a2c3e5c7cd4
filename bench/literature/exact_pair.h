#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/exact_checker.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
/// Two shapes as a collision problem: b is link 0, a is the world.
std::shared_ptr<const CollisionProblem> pairProblem(const Shape& a, const Shape& b);

/// The exact checker for two shapes, on the CPU.
class ExactPair
{
 public:
  explicit ExactPair(std::shared_ptr<const CollisionProblem> problem);
  /// `b_in_a`: the pose of b in the frame of a. Thread-safe if each thread has its own scratch.
  bool collides(const Eigen::Isometry3d& b_in_a, ExactChecker::Scratch& scratch) const;
  /// One byte for each pose, on all cores: 1 for a collision.
  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) const;

 private:
  ExactChecker exact_;
};
}  // namespace gpu_planning_scene::core::literature
