#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Translucent markers (namespace animation) of the bodies that a path moves, in any state of the path. The markers are
/// made once. Each state only changes their poses.
class AnimatedBodies
{
 public:
  /// `path`: rows of all variables. If meshes have more than `max_triangles` triangles in total, the largest are drawn
  /// as boxes.
  AnimatedBodies(const PlanningScene& scene, const Group& group, const std::vector<std::vector<double>>& path,
                 std::size_t max_triangles);

  /// The markers in a state. They replace those of earlier states in RViz. The reference is valid until the next call.
  const visualization_msgs::MarkerArray& at(const std::vector<double>& state);

 private:
  struct Place
  {
    std::size_t link;
    Eigen::Isometry3d pose;  // of the marker, in the frame of the link
  };

  const std::shared_ptr<const RobotModel> robot_;
  visualization_msgs::MarkerArray array_;
  std::vector<Place> places_;  // one per marker
};
}  // namespace gpu_planning_scene::core
