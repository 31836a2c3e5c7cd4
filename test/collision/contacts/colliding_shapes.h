#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"
#include "oracle/oracle.h"
#include "support/moving_shape.h"

namespace gpu_planning_scene::core
{
using Random = std::mt19937_64;

double between(Random& random, double low, double high);
Eigen::Vector3d randomDirection(Random& random);

struct Kind
{
  std::string name;
  bool is_convex;
  std::function<Shape(Random&)> make;
};

/// Kinds of shapes of 0.1 m to 0.6 m.
std::vector<Kind> kinds();

/// Half-spaces, which only an object can have.
Kind halfSpaces();

/// Finds poses in which the held shape collides with an object: it approaches the object's first shape from a random
/// direction, so that it is often near the surface.
class CollidingPoses
{
 public:
  CollidingPoses(const Shape& held, const std::vector<PlacedShape>& object, double padding, std::uint64_t seed);

  /// No value if no pose was found.
  std::optional<Eigen::Isometry3d> next();

 private:
  MovingShape moving_;
  PlacedShape first_;
  Random random_;
};

oracle::Motion motionOf(const Eigen::Isometry3d& pose);

/// The distance of a point from a shape, by the oracle.
double distanceTo(const oracle::PreparedShape& shape, const Eigen::Isometry3d& pose, const Eigen::Vector3d& point);
}  // namespace gpu_planning_scene::core
