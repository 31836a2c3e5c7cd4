#pragma once

#include <Eigen/Geometry>

#include "stability/case.h"
#include "stability/random.h"

namespace gpu_planning_scene::core::stability
{
/// The placement of a case in the world: a random motion moves both shapes together by up to `distance` (metres) along
/// each axis from `origin`. One of three motions has only quarter turns, which keep exact contacts exact.
struct Place
{
  double distance = 1.0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// Makes a case from two shapes, with `b` placed in a's frame. Moves both at random, and swaps their roles at random.
Case placed(Random& random, Shape a, Shape b, const Eigen::Isometry3d& b_in_a, const Place& place = {});

/// Sets the required distance to the true distance, or to 1e-3 ... 1e-8 m above or below it. The robot and the world
/// get random shares of it as paddings.
Case withPadding(Random& random, Case made);

/// A pose of b in a's frame near contact. b gets a random rotation, and a point of b is placed on a point of a. Then b
/// is moved in a random direction until the shapes are just apart, and by `offset` (metres) farther.
Eigen::Isometry3d poseNearContact(Random& random, const Shape& a, const Eigen::Vector3d& point_a, const Shape& b,
                                  const Eigen::Vector3d& point_b, double offset);

/// The same with a given start pose and direction.
Eigen::Isometry3d poseNearContact(const Shape& a, const Shape& b, const Eigen::Isometry3d& start,
                                  const Eigen::Vector3d& direction, double offset);

/// A point in a triangle of the mesh; the centre of a primitive.
Eigen::Vector3d innerPoint(Random& random, const Shape& shape);
}  // namespace gpu_planning_scene::core::stability
