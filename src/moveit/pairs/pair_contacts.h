#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "collision/contacts/body_contacts.h"
#include "moveit/pairs/exact_pair.h"

namespace gpu_planning_scene::detector
{
/// The contacts of two shape instances that collide, the deepest first; at least one, and at most `max_contacts`, which
/// must not be 0. Normals point from `a` to `b`. Depths include the paddings. The contacts separate the two shapes, see
/// core::contactsOf; each occupied leaf of an octree has its own contacts. If an instance is faulty, or neither is a
/// solid, the only contact has no depth. At most 256 leaves of an octree have contacts, and each of them, or a pair of
/// other shapes, at most core::kMaxOfPair. `are_all` becomes false where one of these limits is reached, and if the
/// contact has no depth.
std::vector<core::ShapeContact> contactsOf(const ShapeInstance& a, const ShapeInstance& b, std::size_t max_contacts,
                                           PairScratch& scratch, bool* are_all = nullptr);

/// The points of two shape instances that are nearest to each other, on their padded surfaces. `clearance`: of the two
/// instances; it is the distance of the points.
struct NearestPoints
{
  Eigen::Vector3d on_a;
  Eigen::Vector3d on_b;
};
NearestPoints nearestPointsOf(const ShapeInstance& a, const ShapeInstance& b, double clearance, PairScratch& scratch);
}  // namespace gpu_planning_scene::detector
