#pragma once

#include <memory>
#include <unordered_map>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Refuses a scene that no checker can use. Scenes may come from a program as well as from a file. Throws Error for:
/// two bodies of one name; an invalid pose or shape; a padding that is negative or above 1000 km; a wrong number of
/// link paddings; a half-space in a link or an attached object; an attached object with links that the robot does not
/// have, or without its link's scale. The shapes of the robot were checked when it was loaded.
void validateScene(const PlanningScene& scene);

/// Validates one scene after the other. Each mesh is checked only once, because meshes never change.
class SceneValidator
{
 public:
  void validate(const PlanningScene& scene);

 private:
  /// Weak pointers, because a new mesh may get the address of a destroyed mesh.
  std::unordered_map<const Mesh*, std::weak_ptr<const Mesh>> valid_;
};

bool hasHalfSpace(const std::vector<PlacedShape>& shapes);
}  // namespace gpu_planning_scene::core
