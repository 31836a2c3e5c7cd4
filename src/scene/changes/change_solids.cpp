#include "gpu_planning_scene/error.h"
#include "scene/changes/scene_changer.h"
#include "scene/solid_rules.h"

// Rules for the solids of the meshes of links and objects.
namespace gpu_planning_scene::core
{
void SceneChanger::changeSolids(const SceneChange& change)
{
  PlanningScene& scene = result_.scene;
  std::map<std::string, SolidRule> links;
  for (const auto& [name, rule] : change.solids)
    if (scene.robot->linkIndex(name) >= 0)
      links[name] = rule;
    else if (WorldObject* object = objects_.find(name))
      setSolidRule(object->shapes, rule);
    else if (AttachedObject* attached = attached_.find(name))
    {
      setSolidRule(attached->object.shapes, rule);
      scene.scaleAttached(*attached);
    }
    else
      throw Error("solids: there is no link or object '" + name + "'");
  if (!links.empty())
    scene.robot = scene.robot->withSolids(links);
}
}  // namespace gpu_planning_scene::core
