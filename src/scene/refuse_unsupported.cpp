#include "scene/scene_reader.h"

// What MoveIt's messages can say and this package does not model yet: better no answer than one for another scene.

namespace gpu_planning_scene
{
void refuseUnsupported(const YamlValue& scene)
{
  if (const YamlValue* scales = scene.find("link_scale"))
    for (const YamlValue& item : scales->items())
      if (item.at("scale").number() != 1.0)
        item.fail("link_scale is not supported yet; only a scale of 1 is");
  const YamlValue* world = scene.find("world");
  const YamlValue* octomap = world ? world->find("octomap") : nullptr;
  const YamlValue* tree = octomap ? octomap->find("octomap") : nullptr;
  const YamlValue* data = tree ? tree->find("data") : nullptr;
  if (data && !data->items().empty())
    data->fail("octomaps are not supported yet");
}
}  // namespace gpu_planning_scene
