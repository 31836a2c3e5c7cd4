#pragma once

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// A convex set, by its support function.
class Convex
{
 public:
  virtual ~Convex() = default;

  /// A point of the set that is farthest in a direction; the direction has any length, also 0.
  virtual Eigen::Vector3d farthest(const Eigen::Vector3d& direction) const = 0;

  /// A point of the set, and how far the others may be from it.
  virtual Eigen::Vector3d center() const = 0;
  virtual double radius() const = 0;
};

/// Whether the distance of two convex sets, whose coordinates are in one frame, is at most `distance` (above 0). Right
/// where the true distance is not within about 1e-14 times the sets' size of it, or within 1e-12 m. `from_b` is a guess
/// at the direction from b to a, of any length but 0: a good one saves time.
bool convexWithin(const Convex& a, const Convex& b, double distance, const Eigen::Vector3d& from_b);
}  // namespace gpu_planning_scene::core
