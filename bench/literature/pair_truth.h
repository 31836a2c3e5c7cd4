#pragma once

#include <limits>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"
#include "oracle/oracle.h"
#include "oracle/prepared_mesh.h"

namespace gpu_planning_scene::core::literature
{
/// True distances of two meshes by the oracle of the tests, in quadruple precision. Immutable; threads may share it.
class PairTruth
{
 public:
  PairTruth(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b);

  /// The distance of the surfaces; 0 if they have a common point. If it is at least `limit`, the result is some value
  /// of at least `limit`. `b_in_a`: the pose of b in the frame of a.
  double surfaces(const Eigen::Isometry3d& b_in_a, double limit = std::numeric_limits<double>::infinity()) const;
  /// The same, but closed components are solids.
  double solids(const Eigen::Isometry3d& b_in_a, double limit = std::numeric_limits<double>::infinity()) const;

 private:
  oracle::PreparedShape solid_a_;
  oracle::PreparedShape solid_b_;
  oracle::PreparedMesh surface_a_;
  oracle::PreparedMesh surface_b_;
};
}  // namespace gpu_planning_scene::core::literature
