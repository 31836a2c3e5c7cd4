#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core::literature
{
/// The part of space that a view shows, in the frame of the views. A view along an axis shows the pixels of `common` in
/// the other two axes. Depths range over `whole`: with the depths of `common`, the near and far planes would cut off
/// the fronts and backs of surfaces.
struct ViewVolume
{
  Eigen::AlignedBox3d common;  ///< the intersection of the bounding boxes of the two shapes
  Eigen::AlignedBox3d whole;   ///< their union
};

/// No value if the boxes have no common point: the shapes cannot collide.
std::optional<ViewVolume> viewVolume(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b);

/// The axes of one to three views: first the axis along which `common` is shortest, so that the picture shows its
/// largest side. Three views have the order x, y, z.
std::vector<int> viewAxes(const ViewVolume& volume, int views);

/// A linear map and a translation: [rotation and scale | translation].
using Projection = Eigen::Matrix<double, 3, 4>;

/// The parallel projection along an axis onto the cube from -1 to 1. The picture extends half a pixel beyond `common`,
/// so that it shows edges on the border. As with glOrtho, the depth z grows away from the viewer, so triangles that
/// face the viewer are counterclockwise. `resolution`: pixels along each side.
Projection projectionAlong(int axis, const ViewVolume& volume, int resolution);
}  // namespace gpu_planning_scene::core::literature
