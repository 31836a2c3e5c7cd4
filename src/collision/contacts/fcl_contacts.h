#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/contacts/fcl_models.h"
#include "collision/exact/cpu_forest.h"
#include "collision/exact/cpu_shape_pair.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// Of two shapes a and b.
struct ShapeContact
{
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  ///< unit, from a to b
  double depth;            ///< metres
};

/// A shape in the planning frame.
struct FclShape
{
  std::uint32_t tree;
  Eigen::Isometry3d pose;
  FclGeometry model;  ///< see makeFclSolid
};

/// Contacts of a pair of shapes that collides by the exact test: at least one. FCL tells them where it finds any. Else
/// there is one, see StateInspector::contacts. `required`: the pair's distance, which counts as depth.
std::vector<ShapeContact> contactsOf(const FclShape& a, const FclShape& b, double required, const CpuForest& forest,
                                     const CpuShapePair& exact, CpuShapePair::Scratch& scratch);

/// The contact of a shape, a solid or a mesh, with a half-space: where it reaches deepest.
ShapeContact contactOf(const Eigen::Isometry3d& pose, const Shape& shape, const WorldHalfSpace& half_space,
                       double required);
}  // namespace gpu_planning_scene::core
