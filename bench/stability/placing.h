#pragma once

#include <Eigen/Geometry>

#include "stability/case.h"
#include "stability/random.h"

namespace gpu_planning_scene::core::stability
{
/// How cases are placed in the world: a random motion of both, by up to `distance` along each axis, from `origin`. One
/// in three has quarter turns only, which keep exact contacts exact.
struct Place
{
  double distance = 1.0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// A case from shapes with `b` placed in a's frame: both are moved at random, and change sides at random.
Case placed(Random& random, Shape a, Shape b, const Eigen::Isometry3d& b_in_a, const Place& place = {});

/// Makes the required distance the true one, or 1e-3 ... 1e-8 m more or less, split between robot and world.
Case withPadding(Random& random, Case made);

/// Where b is in a's frame when it is turned at random, placed so that a point of b meets a point of a, and moved
/// from there in a random direction until they are just apart: the last place of contact, moved on by `offset`.
Eigen::Isometry3d justApart(Random& random, const Shape& a, const Eigen::Vector3d& point_a, const Shape& b,
                            const Eigen::Vector3d& point_b, double offset);

/// The same with a given rotation and direction.
Eigen::Isometry3d justApart(const Shape& a, const Shape& b, const Eigen::Isometry3d& start,
                            const Eigen::Vector3d& direction, double offset);

/// A point in the triangle, or in a convex body.
Eigen::Vector3d innerPoint(Random& random, const Shape& shape);
}  // namespace gpu_planning_scene::core::stability
