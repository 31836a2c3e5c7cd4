#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "collision/contacts/fcl_models.h"
#include "collision/exact/cpu_forest.h"
#include "collision/exact/cpu_shape_pair.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// A contact of two shapes a and b, in the planning frame.
struct ShapeContact
{
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  ///< unit vector from a to b
  double depth;            ///< metres
};

/// A shape in the planning frame.
struct FclShape
{
  std::uint32_t tree;
  Eigen::Isometry3d pose;
  FclGeometry model;  ///< see makeFclSolid
};

/// The largest number of contacts of one pair, unless a caller wants more.
constexpr std::size_t kMaxOfPair = 256;

/// The contacts of two shapes that collide by the exact test; at least one, and at most `max_contacts`. FCL's contacts
/// are used if FCL finds any. Otherwise there is exactly one contact, see StateInspector::contacts. `required` is the
/// required distance of the pair; the depths include it.
std::vector<ShapeContact> contactsOf(const FclShape& a, const FclShape& b, double required, const CpuForest& forest,
                                     const CpuShapePair& exact, CpuShapePair::Scratch& scratch,
                                     std::size_t max_contacts = kMaxOfPair);

/// FCL's nearest points are used only if their distance is correct to this.
constexpr double kNearEnough = 1e-4;  // metres

/// The nearest points of two shapes by FCL. Empty unless their distance is within `tolerance` of `distance`.
std::optional<std::array<Eigen::Vector3d, 2>> fclNearestPoints(const FclShape& a, const FclShape& b, double distance,
                                                               double tolerance = kNearEnough);

/// The contact of a primitive or mesh with a half-space, at the deepest point of the shape.
ShapeContact contactOf(const Eigen::Isometry3d& pose, const Shape& shape, const WorldHalfSpace& half_space,
                       double required);
}  // namespace gpu_planning_scene::core
