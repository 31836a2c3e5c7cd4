#pragma once

#include <limits>
#include <memory>

#include "gpu_planning_scene/shapes.h"
#include "oracle/quad.h"

namespace gpu_planning_scene::core::oracle
{
/// The verdict of the project's contract on a pair whose true distance is d and whose required distance is v.
enum class Verdict
{
  Collides,  ///< d <= v
  Free,      ///< d > v + 1e-9 m
  Either     ///< v < d <= v + 1e-9 m: the contract allows both answers
};

constexpr double kTolerance = 1e-9;  // metres: the tolerance of the contract
/// Accuracy of distances between curved surfaces. Distances of triangles and half-spaces are exact to about 1e-28.
constexpr double kAccuracy = 1e-13;  // metres, for shapes of up to a few metres

/// A shape with the data that distance() and verdict() need. Immutable; threads may share it.
class PreparedShape
{
 public:
  explicit PreparedShape(const Shape& shape);
  ~PreparedShape();
  PreparedShape(const PreparedShape&) = delete;
  PreparedShape& operator=(const PreparedShape&) = delete;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<const Impl> impl_;
};

/// The distance of two placed shapes as sets of points: surfaces, primitives, and the solids inside closed components
/// of a mesh. It is 0 if the shapes have a common point. At most one shape is a half-space. If the distance is at least
/// `limit`, the result is some value of at least `limit`.
double distance(const PreparedShape& a, const Motion& pose_a, const PreparedShape& b, const Motion& pose_b,
                double limit = std::numeric_limits<double>::infinity());

/// The verdict on a pair. It computes the distance only as accurately as the verdict needs.
Verdict verdict(const PreparedShape& a, const Motion& pose_a, const PreparedShape& b, const Motion& pose_b,
                double required_distance);
}  // namespace gpu_planning_scene::core::oracle
