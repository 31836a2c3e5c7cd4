#pragma once

#include <memory>
#include <unordered_map>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// What no checker can use, as scenes may come from a program as well as from a file: throws Error for two objects of
/// one name, a pose or shape that is not valid, a negative padding, a half-space in a link or a carried object, or an
/// attached object whose links the robot does not have. (The robot's shapes were checked when it was loaded.)
void validateScene(const PlanningScene& scene);

/// The same for scene after scene: meshes, which never change, are looked through once.
class SceneValidator
{
 public:
  void validate(const PlanningScene& scene);

 private:
  /// Weak: a mesh that is gone may leave its address to another.
  std::unordered_map<const Mesh*, std::weak_ptr<const Mesh>> valid_;
};

bool hasHalfSpace(const std::vector<PlacedShape>& shapes);
}  // namespace gpu_planning_scene::core
