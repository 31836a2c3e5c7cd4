#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <visualization_msgs/MarkerArray.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
struct MarkerOptions
{
  ros::Time stamp;
  /// [~markers/triangles] where meshes and cones have more in all, the largest are drawn as their boxes; and a tree's
  /// boxes are then of a level further up.
  std::size_t most_triangles = 500000;
  int tree_level = -1;    ///< the boxes of this level of the trees, the root's being 0; -1: none
  std::string tree_body;  ///< of one body alone; empty: of all
};

/// Throws Error for a level below -1, and for a name that no link and no object has; an empty one means all.
void requireTreeLevel(const PlanningScene& scene, int level, const std::string& body);

/// What RViz draws: the robot, the objects and what is carried, in the planning frame, colliding bodies red; contact
/// points; the boxes of a tree level. The first marker deletes those of before. Namespaces: robot, objects, attached,
/// contacts, tree.
visualization_msgs::MarkerArray markersOf(const PlanningScene& scene, const double* state,
                                          const std::vector<BodyPair>& colliding,
                                          const std::vector<Eigen::Vector3d>& contact_points,
                                          const MarkerOptions& options);
}  // namespace gpu_planning_scene::core
