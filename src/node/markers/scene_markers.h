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
  /// [~markers/triangles] If meshes and cones together have more triangles, the largest are drawn as boxes. If there is
  /// no room for the boxes of `tree_level`, the boxes of a level nearer to the root are drawn.
  std::size_t max_triangles = 500000;
  int tree_level = -1;    ///< draws the boxes of this level of the trees; 0: the roots, -1: none
  std::string tree_body;  ///< draws the tree boxes of this body only; empty: of all bodies
};

/// Throws Error for a level below -1, and for a name that no link and no object has. An empty name means all bodies.
void requireTreeLevel(const PlanningScene& scene, int level, const std::string& body);

/// Markers for RViz, in the planning frame: the robot, the objects and the attached objects, with colliding bodies in
/// red; contact points; the boxes of a tree level. The first marker deletes all earlier markers. Namespaces: robot,
/// objects, attached, contacts, tree.
visualization_msgs::MarkerArray markersOf(const PlanningScene& scene, const double* state,
                                          const std::vector<BodyPair>& colliding,
                                          const std::vector<Eigen::Vector3d>& contact_points,
                                          const MarkerOptions& options);
}  // namespace gpu_planning_scene::core
