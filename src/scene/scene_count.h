#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// Holds what a scene has against its limits. Throws Error that names the limit as the node's parameters do.
class SceneCount
{
 public:
  SceneCount(const SceneLimits& limits, const PlanningScene& scene);

  /// Before the object is kept.
  void add(const std::string& id, const std::vector<PlacedShape>& shapes);
  void remove(const std::vector<PlacedShape>& shapes);
  /// Of the whole scene, where a mesh was added.
  void requireTriangles(const PlanningScene& scene) const;

  /// Of the whole scene.
  void requireFramesAndColors(const PlanningScene& scene) const;

  /// A name that is not empty, not longer than the limit, and one line. `what` it is, for the message.
  void requireName(const std::string& name, const std::string& what) const;
  void requireMatrix(const AllowedCollisionMatrix& matrix) const;

 private:
  const SceneLimits& limits_;
  std::size_t objects_;
  std::size_t shapes_ = 0;
  bool has_new_mesh_ = false;
};
}  // namespace gpu_planning_scene::core
