#include "scene/scene_reader.h"

// Parts of MoveIt's messages that this package does not model. They are refused, because an answer would be for another
// scene.

namespace gpu_planning_scene::core
{
void refuseUnsupported(const YamlValue& scene)
{
  const YamlValue* world = scene.find("world");
  const YamlValue* octomap = world ? world->find("octomap") : nullptr;
  const YamlValue* tree = octomap ? octomap->find("octomap") : nullptr;
  const YamlValue* data = tree ? tree->find("data") : nullptr;
  if (data && !data->items().empty())
    data->fail("octomaps are not supported; give the obstacles as objects or as a point cloud");
}
}  // namespace gpu_planning_scene::core
