#include "scene/scene_reader.h"

// What MoveIt's messages can say and this package does not model yet: better no answer than one for another scene.

namespace gpu_planning_scene
{
namespace
{
void refuseOtherThan(const YamlValue& scene, const char* list_key, const char* value_key, double neutral)
{
  const YamlValue* list = scene.find(list_key);
  if (!list)
    return;
  for (const YamlValue& item : list->items())
    if (item.at(value_key).number() != neutral)
      item.fail(std::string(list_key) + " is not supported yet");
}
}  // namespace

void refuseUnsupported(const YamlValue& scene)
{
  refuseOtherThan(scene, "link_padding", "padding", 0.0);
  refuseOtherThan(scene, "link_scale", "scale", 1.0);
  const YamlValue* state = scene.find("robot_state");
  const YamlValue* attached = state ? state->find("attached_collision_objects") : nullptr;
  if (attached && !attached->items().empty())
    attached->fail("attached objects are not supported yet");
  const YamlValue* world = scene.find("world");
  const YamlValue* octomap = world ? world->find("octomap") : nullptr;
  const YamlValue* tree = octomap ? octomap->find("octomap") : nullptr;
  const YamlValue* data = tree ? tree->find("data") : nullptr;
  if (data && !data->items().empty())
    data->fail("octomaps are not supported yet");
}

void refuseUnsupportedInObject(const YamlValue& object, const SceneReader& reader)
{
  const YamlValue* planes = object.find("planes");
  if (planes && !planes->items().empty())
    planes->fail("planes are not supported yet; use a thin box");
  const YamlValue* subframes = object.find("subframe_names");
  if (subframes && !subframes->items().empty())
    reader.warn(subframes->where() + ": subframes are not used");
}
}  // namespace gpu_planning_scene
