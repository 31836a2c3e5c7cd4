#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "collision/contacts/contact_shape.h"
#include "collision/exact/cpu_shape_pair.h"
#include "collision/exact/pair_clearance.h"

namespace gpu_planning_scene::core
{
/// A contact of two bodies a and b.
struct ShapeContact
{
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  ///< unit vector from a to b
  double depth;            ///< metres
};

/// The largest number of contacts of one pair, unless a caller wants more.
constexpr std::size_t kMaxOfPair = 256;

/// The contacts of two bodies: at least one, and at most `most`, which must not be 0. `pairs`: the pairs of shapes of
/// the bodies that are checked. `colliding`: the numbers of the pairs that collide by the exact test; at least one. All
/// contacts have the same normal and depth, see findSeparation; the first one is where the bodies overlap most. See
/// StateInspector::contacts for the points.
std::vector<ShapeContact> contactsOf(const std::vector<ContactPair>& pairs, const std::vector<std::size_t>& colliding,
                                     const CpuShapePair& exact, CpuShapePair::Scratch& scratch,
                                     std::size_t most = kMaxOfPair);

/// The contact of a shape a with a half-space b, at the deepest point of the shape.
ShapeContact contactWithHalfSpace(const ContactShape& a, const PlacedHalfSpace& b, double required);

/// No translation of at most this length separates two shapes that collide, in metres; 0: no such length is known.
/// `point`: of both shapes, if there is one.
double leastDepthOf(const ContactPair& pair, const Eigen::Vector3d& point);

/// The nearest points of two shapes that do not collide, up to 1e-6 m in their distance. `distance`: of the shapes, as
/// pairClearance computes it.
std::array<Eigen::Vector3d, 2> nearestPointsOf(const ContactShape& a, const ContactShape& b, double distance);

/// The nearest points of two parts of shapes that do not collide.
std::array<Eigen::Vector3d, 2> nearestPointsOf(const ContactShape& a, const ContactShape& b, const ShapeParts& parts);
}  // namespace gpu_planning_scene::core
