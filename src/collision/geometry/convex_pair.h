#pragma once

#include <cstdint>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// A convex set that is described by its support function, as for the algorithm of Gilbert, Johnson and Keerthi (1988).
class Convex
{
 public:
  virtual ~Convex() = default;

  /// A point of the set that is farthest along a direction of any length. For the direction 0, any point.
  virtual Eigen::Vector3d farthest(const Eigen::Vector3d& direction) const = 0;

  /// A point of the set, and the radius of a sphere around it that contains the set.
  virtual Eigen::Vector3d center() const = 0;
  virtual double radius() const = 0;
};

/// A direction from one convex set to another along which they were farther apart than a distance. It likely separates
/// the next pair too, if this pair is near.
struct SeparatingAxis
{
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< from b to a, of any length; 0: none is known
  std::uint64_t searches = 0;                           ///< pairs for which a separating direction had to be searched
};

/// Whether the distance between two convex sets is at most `distance` (above 0). Both sets have their coordinates in
/// the same frame. The answer is right unless the true distance differs from `distance` by less than about 1e-14 times
/// the sizes of the sets, or by less than 1e-12 m. `from_b` is a guess of the direction from b to a. It may have any
/// length except 0. A good guess saves time. `axis`: is tried first, and is set if another direction separates the
/// sets; null: none.
bool convexWithin(const Convex& a, const Convex& b, double distance, const Eigen::Vector3d& from_b,
                  SeparatingAxis* axis = nullptr);

/// The distance between two convex sets, at most 1e-7 m above the true distance for nearly all pairs; 0 if the sets
/// intersect. `from_b`: see convexWithin(); it may also be 0.
double convexDistance(const Convex& a, const Convex& b, const Eigen::Vector3d& from_b);
}  // namespace gpu_planning_scene::core
