#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

/// Poses of a mesh b in the frame of a mesh a. All lengths in metres.
namespace gpu_planning_scene::core::literature
{
/// Random rotations. The centre of b has `distance` from the centre of a, in a random direction.
std::vector<Eigen::Isometry3d> posesAt(double distance, std::size_t count, std::uint64_t seed);

/// 60 rotations of b, whose centre lies at `distance` from the centre of a along x: steps of 30 degrees about z,
/// combined with steps of 30 degrees about x. After the benchmark of G. Zachmann, "Rapid Collision Detection by
/// Dynamically Aligned DOP-Trees" (1998). The order of the poses is random, so that the first ones are a sample of all.
std::vector<Eigen::Isometry3d> turningPoses(double distance, std::uint64_t seed);

/// Random rotations and directions, `count` for each clearance. b comes from outside along its direction until the
/// surfaces have the clearance, up to a hundredth of it. `size`: of both meshes. After S. Trenkel, R. Weller,
/// G. Zachmann, "A Benchmarking Suite for Static Collision Detection Algorithms" (2007). Poses for which the search
/// does not end are left out.
std::vector<std::vector<Eigen::Isometry3d>> posesWithClearances(const Mesh& a, const Mesh& b, double size,
                                                                const std::vector<double>& clearances,
                                                                std::size_t count, std::uint64_t seed);
}  // namespace gpu_planning_scene::core::literature
