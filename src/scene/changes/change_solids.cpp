#include "gpu_planning_scene/error.h"
#include "scene/changes/scene_changer.h"
#include "scene/solid_rules.h"

// Rules for the solids of the meshes of links and objects.
namespace gpu_planning_scene::core
{
void SceneChanger::changeSolids(const SceneChange& change)
{
  PlanningScene& scene = result_.scene;
  const auto require_mesh = [](const std::string& name, const std::vector<PlacedShape>& shapes)
  {
    if (!solidRuleOf(shapes))
      throw Error("solids: '" + name + "' has no mesh; only meshes have a rule for their solid");
  };
  std::map<std::string, SolidRule> links;
  for (const auto& [name, rule] : change.solids)
  {
    WorldObject* const object = objects_.find(name);
    AttachedObject* const attached = attached_.find(name);
    if (const int link = scene.robot->linkIndex(name); link >= 0)
    {
      require_mesh(name, scene.robot->links()[static_cast<std::size_t>(link)].shapes);
      links[name] = rule;
    }
    else if (object != nullptr)
    {
      require_mesh(name, object->shapes);
      setSolidRule(object->shapes, rule);
    }
    else if (attached != nullptr)
    {
      require_mesh(name, attached->object.shapes);
      if (setSolidRule(attached->object.shapes, rule))
        scene.scaleAttached(*attached);
    }
    else
      throw Error("solids: there is no link or object '" + name + "'");
  }
  if (!links.empty())
    scene.robot = scene.robot->withSolids(links);
}
}  // namespace gpu_planning_scene::core
