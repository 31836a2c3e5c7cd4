#pragma once

#include <string>
#include <vector>

#include <geometric_shapes/shapes.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::pipeline
{
/// Whether a body is a part of the robot. Half-spaces can only be in the world.
enum class Carried
{
  No,
  Yes
};

/// Appends a shape of MoveIt to the shapes of a body. An octree becomes the cubes of its occupied leaves, as they are
/// now; a mesh without triangles becomes nothing. Meshes come from the shape cache of the detector, so a shape of
/// MoveIt has the same mesh in every conversion. `scale`: as for detector::CollisionShape. `body`: its name, for
/// messages. Throws Refusal with COLLISION_CHECKING_UNAVAILABLE if the shape cannot be expressed exactly.
void addShapes(const shapes::ShapeConstPtr& shape, const Eigen::Isometry3d& pose, double scale, Carried carried,
               const std::string& body, std::vector<core::PlacedShape>& added);
}  // namespace gpu_planning_scene::pipeline
