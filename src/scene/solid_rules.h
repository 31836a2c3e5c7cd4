#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The rule of the first mesh among the shapes; no value: there is no mesh. All meshes of a body have one rule.
std::optional<SolidRule> solidRuleOf(const std::vector<PlacedShape>& shapes);

/// The rules of a scene that are needed to make it again: those of all links with meshes, because a full scene does not
/// reset them, and those of objects that are not SolidRule::Auto.
std::map<std::string, SolidRule> solidRulesOf(const PlanningScene& scene);
}  // namespace gpu_planning_scene::core
