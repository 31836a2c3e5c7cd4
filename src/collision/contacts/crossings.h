#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/contacts/contact_shape.h"
#include "collision/exact/pair_clearance.h"
#include "collision/geometry/triangle_pair.h"

namespace gpu_planning_scene::core
{
/// The parts that are within `reach` of each other by the exact tests, at most `most` of them. At least one of the two
/// shapes must be a mesh. A triangle inside a primitive is within its reach.
std::vector<ShapeParts> crossingsOf(const ContactShape& a, const ContactShape& b, double reach, std::size_t most);

/// The triangles of two boxes that meet, at most `most` pairs; none if a tree has no triangles.
std::vector<ShapeParts> crossingsOfBoxes(const ContactShape& a, const ContactShape& b, std::size_t most);

/// Points of the two parts. They are equal up to 1e-8 m if the parts meet, and otherwise the nearest points.
std::array<Eigen::Vector3d, 2> pointsOf(const ContactShape& a, const ContactShape& b, const ShapeParts& crossing);

/// A triangle of a shape, in the frame of its pose.
Triangle placedTriangle(const ContactShape& shape, std::uint32_t number);
}  // namespace gpu_planning_scene::core
