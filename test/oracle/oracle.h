#pragma once

#include <limits>
#include <memory>

#include "gpu_planning_scene/shapes.h"
#include "oracle/quad.h"

namespace gpu_planning_scene::core::oracle
{
/// What the project's contract says of a pair whose true distance is d and whose required distance is v.
enum class Verdict
{
  Collides,  ///< d <= v
  Free,      ///< d > v + 1e-9 m
  Either     ///< in between
};

constexpr double kTolerance = 1e-9;  // metres: of the contract
/// Distances between curved surfaces are found to this; those of triangles and half-spaces are exact to about 1e-28.
constexpr double kAccuracy = 1e-13;  // metres, for shapes of up to metres

/// A shape made ready for questions about it. Immutable; may be shared by threads.
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

/// The distance of two placed shapes as sets of points: of surfaces, of the solids that the closed components of a mesh
/// bound, and of primitives; 0 where they have a point in common. At least one is not a half-space. From `limit` up
/// the answer is some distance of at least `limit`.
double distance(const PreparedShape& a, const Motion& pose_a, const PreparedShape& b, const Motion& pose_b,
                double limit = std::numeric_limits<double>::infinity());

/// Looks only as closely as the answer needs.
Verdict verdict(const PreparedShape& a, const Motion& pose_a, const PreparedShape& b, const Motion& pose_b,
                double required_distance);
}  // namespace gpu_planning_scene::core::oracle
