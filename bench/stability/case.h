#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::stability
{
/// Two placed shapes. `a` belongs to a robot; `b` to the world, or to another link of the robot (`self`).
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
  std::optional<double> known;  ///< the distance by construction, where that gives it to 1e-11 m
};

/// Up to which distance the two collide. Pairs of a robot's own bodies are not padded.
inline double requiredDistance(const Case& c)
{
  return c.self ? 0.0 : c.padding_a + c.padding_b;
}

/// A kind of cases. Case `index` depends on the seed and the index alone, so that each can be had again.
struct Family
{
  std::string name;
  std::function<Case(std::uint64_t seed, std::size_t index)> make;
  /// Both shapes are triangles, or meshes and boxes: what a plain triangle test can be asked.
  bool triangles = true;
  /// Both shapes are convex bodies.
  bool convex = false;
  /// Case i and case i + 1 are one pair, in other orders of vertices and arguments, where i / copies is the same.
  std::size_t copies = 1;
  /// Near the robot, in the planning frame.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// All of them, in the order of the table.
std::vector<Family> allFamilies();

// Its parts.
std::vector<Family> triangleFamilies();
std::vector<Family> contactFamilies();
std::vector<Family> containmentFamilies();
std::vector<Family> primitiveFamilies();
std::vector<Family> paddingFamilies();
}  // namespace gpu_planning_scene::core::stability
