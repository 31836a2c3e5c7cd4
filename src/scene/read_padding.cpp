#include <algorithm>

#include "scene/scene_reader.h"

namespace gpu_planning_scene
{
std::vector<double> readLinkPadding(const YamlValue& scene, const SceneReader& reader)
{
  const YamlValue* list = scene.find("link_padding");
  if (!list)
    return {};
  std::vector<double> padding(reader.robot.links().size(), 0.0);
  std::vector<bool> given(padding.size(), false);
  for (const YamlValue& item : list->items())
  {
    item.warnOfUnknownKeys({"link_name", "padding"}, reader.warnings);
    const YamlValue& name = item.at("link_name");
    const YamlValue& value = item.at("padding");
    const double metres = value.number();
    if (metres < 0.0)
      value.fail("the padding of link '" + name.text() + "' is negative; it must be at least 0 m");
    const int link = reader.robot.linkIndex(name.text());
    if (link < 0)
    {
      reader.warn(name.where() + ": padding not used, the robot has no link '" + name.text() + "'");
      continue;
    }
    if (given[link])
      name.fail("the padding of link '" + name.text() + "' is given twice");
    given[link] = true;
    padding[link] = metres;
  }
  const bool padded = std::any_of(padding.begin(), padding.end(), [](double metres) { return metres > 0.0; });
  return padded ? padding : std::vector<double>();
}
}  // namespace gpu_planning_scene
