#pragma once

#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "collision/exact/exact_checker.h"

namespace gpu_planning_scene::core
{
struct PairPadding
{
  double moving = 0.0;
  double objects = 0.0;
};

/// A moving shape (body 0) and objects (bodies 1 and up), each with its padding. No robot is needed.
class MovingShape
{
 public:
  using Build = std::function<Forest(const std::vector<Tessellation>&)>;

  MovingShape(const Shape& moving, const std::vector<PlacedShape>& objects, const PairPadding& padding = {},
              const Build& build = {});

  bool collides(const Eigen::Isometry3d& pose) { return exact_->firstCollision(&pose, scratch_).has_value(); }
  std::vector<BodyPair> all(const Eigen::Isometry3d& pose) { return exact_->allCollisions(&pose, scratch_); }
  const std::vector<Tessellation>& trees() const { return trees_; }

 private:
  std::vector<Tessellation> trees_;
  std::unique_ptr<ExactChecker> exact_;
  ExactChecker::Scratch scratch_;
};

/// A random rotation, and a random translation of up to `reach` along each axis.
Eigen::Isometry3d randomPose(std::mt19937_64& generator, double reach);

Eigen::Isometry3d at(double x, double y, double z);
}  // namespace gpu_planning_scene::core
