#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "collision/proofs/shape_samples.h"

namespace gpu_planning_scene::core
{
/// The depth of points inside a shape, and points of the shape. They prove that two shapes collide: a point of one
/// shape is deep inside the other shape. Own method. Immutable.
class SolidDepth
{
 public:
  /// `sagitta`: see Tessellation.
  SolidDepth(const ShapeSamples& samples, double sagitta);

  /// Some points of the shape, at its surface, in its frame.
  const std::vector<Eigen::Vector3d>& points() const { return points_; }

  /// A lower bound of the depth of a point below the surface of the shape's solid, in metres; 0: the point may be
  /// outside the solid. The depth is known at the centres of cubes; it changes by at most the distance between points.
  double at(const Eigen::Vector3d& point) const;

 private:
  std::vector<Eigen::Vector3d> points_;
  CubeGrid grid_;
  std::vector<float> depths_;  // of the centres of the cubes
};
}  // namespace gpu_planning_scene::core
