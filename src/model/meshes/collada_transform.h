#pragma once

#include <Eigen/Geometry>

namespace tinyxml2
{
class XMLElement;
}

namespace gpu_planning_scene::core
{
/// Whether the element is a transform of a <node>.
bool isColladaTransform(const tinyxml2::XMLElement& element);

/// The transform. Throws Error if it cannot be read.
Eigen::Affine3d colladaTransform(const tinyxml2::XMLElement& element);
}  // namespace gpu_planning_scene::core
