#pragma once

#include <vector>

#include "collision/cpu/lanes/lane_model.h"
#include "collision/problem/collision_problem.h"
#include "collision/trees/cpu_forest.h"

namespace gpu_planning_scene::core
{
/// An object of the world in the form of the lane kernel.
struct LaneObject
{
  lanes::Object object;
  double padding;              ///< metres
  double thickness;            ///< metres: the object contains a ball of this radius; 0: unknown
  double largest_distance;     ///< metres: its size, plus the distance of its frame from the origin of coordinates
  Eigen::AlignedBox3d bounds;  ///< in the coordinates of the kernel; without limits for half-spaces
};

/// The world's instances, then its half-spaces. `origin`: of the kernel's coordinates, in the planning frame.
std::vector<LaneObject> laneObjects(const CollisionProblem& problem, const CpuForest& forest,
                                    const Eigen::Vector3d& origin);

/// A box around an object: a point within `reach` of the origin of coordinates is not farther from the object than from
/// the box.
Eigen::AlignedBox3d boundsWithin(const LaneObject& object, double reach);

/// The indices of the objects in an order in which neighbours are near each other.
std::vector<std::uint32_t> nearOrder(const std::vector<LaneObject>& objects);

/// Writes the first three rows of a pose.
void writePose(const Eigen::Isometry3d& pose, float* rows);
}  // namespace gpu_planning_scene::core
