#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
constexpr double kUnmoved = 1e-3;  // metres, or entries of a rotation

/// The bodies that the group moves and that are not at the same place in all of the given poses. `poses`: rows of
/// bodyPoses.
std::vector<std::size_t> movedBodies(const PlanningScene& scene, const Group& group,
                                     const std::vector<std::vector<Eigen::Isometry3d>>& poses);
}  // namespace gpu_planning_scene::core
