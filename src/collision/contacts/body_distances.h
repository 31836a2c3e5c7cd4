#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "collision/contacts/inspected_group.h"
#include "gpu_planning_scene/state_inspector.h"

namespace gpu_planning_scene::core
{
/// The distances of one state: see BodyDistances.
struct StateDistances
{
  std::vector<BodyDistance> pairs;
  std::vector<double> gradients;
};

/// See StateInspector::nearestPairs. `link_poses`: one per link, in the planning frame.
NearestPairs nearestPairsOf(const PlanningScene& scene, const InspectedGroup& group,
                            const std::vector<Eigen::Isometry3d>& link_poses);

/// See StateInspector::distances. `link_poses`: those of `state`, in the planning frame.
StateDistances distancesOf(const RobotModel& robot, const InspectedGroup& group, const DistanceQuery& query,
                           const double* state, const std::vector<Eigen::Isometry3d>& link_poses);
}  // namespace gpu_planning_scene::core
