#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::stability
{
/// Two placed shapes. `a` belongs to the robot. `b` belongs to the world, or to another link of the robot if `self`.
struct Case
{
  Shape a;
  Shape b;
  Eigen::Isometry3d link_a = Eigen::Isometry3d::Identity();  ///< in the planning frame
  Eigen::Isometry3d a_in_link = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d pose_b = Eigen::Isometry3d::Identity();  ///< in the planning frame; identity for a half-space
  double padding_a = 0.0;
  double padding_b = 0.0;
  bool self = false;
  std::optional<Shape> true_a;  ///< what the oracle judges instead of `a`: a mesh before it was damaged
  std::optional<Shape> true_b;
  std::optional<double> known;  ///< the distance by construction, if known to 1e-11 m
};

/// The required distance of the pair, in metres. Padding does not apply between two links.
inline double requiredDistance(const Case& c)
{
  return c.self ? 0.0 : c.padding_a + c.padding_b;
}

/// A family of cases. Case `index` depends only on the seed and the index, so each case can be reproduced.
struct Family
{
  std::string name;
  std::function<Case(std::uint64_t seed, std::size_t index)> make;
  /// Both shapes are meshes or boxes, so a plain triangle test applies.
  bool triangles = true;
  /// Both shapes are convex bodies.
  bool convex = false;
  /// All cases with the same value of i / copies are copies of one pair with other orders of vertices and arguments.
  std::size_t copies = 1;
  /// There are no more cases than this.
  std::size_t most = std::numeric_limits<std::size_t>::max();
  /// A point near the robot, in the planning frame; see CollisionProblem::origin.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// All families, in the order of the table.
std::vector<Family> allFamilies();

// The parts of allFamilies().
std::vector<Family> triangleFamilies();
std::vector<Family> contactFamilies();
std::vector<Family> containmentFamilies();
std::vector<Family> primitiveFamilies();
std::vector<Family> paddingFamilies();
std::vector<Family> literatureFamilies();
std::vector<Family> leakyFamilies();
}  // namespace gpu_planning_scene::core::stability
