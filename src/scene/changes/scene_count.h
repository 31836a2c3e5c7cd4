#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// Compares the contents of a scene with its limits. Throws Error that names the limit as the node's parameters do.
class SceneCount
{
 public:
  SceneCount(const SceneLimits& limits, const PlanningScene& scene);

  /// Counts an object with its shapes, before it is added to the scene.
  void add(const std::string& id, const std::vector<PlacedShape>& shapes);
  void remove(const std::vector<PlacedShape>& shapes);
  /// Checks the triangles of the whole scene, if a mesh was added.
  void requireTriangles(const PlanningScene& scene) const;

  /// Checks the frames and colours of the whole scene.
  void requireFramesAndColors(const PlanningScene& scene) const;

  /// Checks that a name is not empty, not longer than the limit, and one line. `what` describes it in the message.
  void requireName(const std::string& name, const std::string& what) const;
  void requireType(const ObjectType& type, const std::string& where) const;
  void requirePosture(const JointTrajectory& posture, const std::string& where) const;
  /// Checks the number of the octomap's occupied leaves.
  void requireVoxels(std::size_t count) const;
  void requireMatrix(const AllowedCollisionMatrix& matrix) const;

 private:
  const SceneLimits& limits_;
  std::size_t objects_;
  std::size_t shapes_ = 0;
  bool has_new_mesh_ = false;
};
}  // namespace gpu_planning_scene::core
