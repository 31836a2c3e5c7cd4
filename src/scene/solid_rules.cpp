#include "scene/solid_rules.h"

namespace gpu_planning_scene::core
{
std::optional<SolidRule> solidRuleOf(const std::vector<PlacedShape>& shapes)
{
  for (const PlacedShape& placed : shapes)
    if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape))
      return (*mesh)->solid;
  return std::nullopt;
}

std::map<std::string, SolidRule> solidRulesOf(const PlanningScene& scene)
{
  std::map<std::string, SolidRule> rules;
  for (const Link& link : scene.robot->links())
    if (const std::optional<SolidRule> rule = solidRuleOf(link.shapes))
      rules[link.name] = *rule;
  const auto add = [&](const WorldObject& object)
  {
    if (const auto rule = solidRuleOf(object.shapes); rule && *rule != SolidRule::Auto)
      rules[object.id] = *rule;
  };
  for (const WorldObject& object : scene.objects)
    add(object);
  for (const AttachedObject& attached : scene.attached)
    add(attached.object);
  return rules;
}
}  // namespace gpu_planning_scene::core
