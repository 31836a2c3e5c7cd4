#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "collision/contacts/contact_shape.h"
#include "collision/contacts/crossings.h"
#include "collision/exact/cpu_shape_pair.h"

namespace gpu_planning_scene::core
{
/// A translation that ends the collisions of two bodies.
struct Separation
{
  Eigen::Vector3d normal;  ///< unit vector from the first body to the second
  double depth;            ///< metres: how far the second body must move along the normal; above 0
};

/// A depth is longer by this than the one at which the bodies only touch.
constexpr double kSeparationGap = 2e-9;  // metres

/// The parts of a colliding pair that meet. The nearest parts if the surfaces do not meet: because one shape is inside
/// the other, or because the pair only misses its required distance. At most `most`; none for two primitives.
std::vector<ShapeParts> meetingParts(const ContactPair& pair, std::size_t most, CpuShapePair::Scratch& scratch);

/// A short translation that ends the collisions of all `pairs`, which are the pairs of shapes of two bodies.
/// `colliding`: the numbers of those pairs that collide; at least one. After the translation, the exact tests find that
/// the bodies are more than 1e-9 m farther apart than required. For one pair of convex solids it is the shortest one,
/// up to 1e-8 of the sizes, or up to 1 % if a round solid or a mesh of many faces contains the middle of the other one
/// (see separationOf). For other pairs it is the shortest of a few directions: the normals of faces that meet, and the
/// directions that are best for the convex hulls of the shapes and of their parts that meet.
Separation findSeparation(const std::vector<ContactPair>& pairs, const std::vector<std::size_t>& colliding,
                          const CpuShapePair& exact, CpuShapePair::Scratch& scratch);
}  // namespace gpu_planning_scene::core
