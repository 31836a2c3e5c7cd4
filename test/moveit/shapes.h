#pragma once

#include <memory>

#include <geometric_shapes/shapes.h>
#include <Eigen/Geometry>

namespace gpu_planning_scene
{
inline Eigen::Isometry3d at(double x, double y, double z)
{
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

inline shapes::ShapeConstPtr box(double x, double y, double z)
{
  return std::make_shared<shapes::Box>(x, y, z);
}

/// A cube.
inline shapes::ShapeConstPtr box(double size)
{
  return box(size, size, size);
}
}  // namespace gpu_planning_scene
