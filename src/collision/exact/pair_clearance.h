#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include "collision/exact/cpu_shape_pair.h"
#include "collision/trees/cpu_tree.h"

namespace gpu_planning_scene::core
{
/// How far bisectLeast may end below the least x.
constexpr double kResolution = 1e-6;  // metres

/// Bisection for the least x in [low, high] with holds(x). `high` must be finite. `holds` must be true for `high` and
/// for all values above the least one. The result is at most 1e-6 m below the least x, and never above it.
///
/// `estimate`: of the least x. If it is right to 0.4e-6 m, two calls of `holds` are enough. Any value is allowed.
template <class Predicate>
double bisectLeast(double low, double high, const Predicate& holds,
                   double estimate = std::numeric_limits<double>::quiet_NaN())
{
  constexpr double kEstimateError = 0.4e-6;
  for (const double tried : {estimate + kEstimateError, estimate - kEstimateError})
    if (tried > low && tried < high)
      (holds(tried) ? high : low) = tried;
  while (high - low > kResolution)
  {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high)
      break;  // doubles of this size have no finer resolution
    (holds(middle) ? high : low) = middle;
  }
  return low;
}

/// Parts of two shapes: a triangle of each mesh, or a primitive as a whole.
struct ShapeParts
{
  static constexpr std::uint32_t kWhole = 0xffffffff;

  std::uint32_t of_a;  ///< index in the triangles of the tree; kWhole: the primitive
  std::uint32_t of_b;
};

/// The clearance of two shapes, in metres, and the parts that are nearest by distances in double arithmetic.
struct PairClearance
{
  double clearance;
  std::optional<ShapeParts> parts;  ///< no value if the clearance is not below `most`
};

/// The clearance of two shapes that do not collide with the required distance `required`: the least x above 0 for which
/// they collide with the required distance `required` + x, as CpuShapePair decides it. If the clearance is `most` or
/// more, the result is `most`. Otherwise the result is at most 1e-6 m below the clearance, and never above it.
PairClearance pairClearance(const CpuTree& a, const Eigen::Isometry3d& pose_a, const CpuTree& b,
                            const Eigen::Isometry3d& pose_b, double required, double most,
                            CpuShapePair::Scratch& scratch);
}  // namespace gpu_planning_scene::core
