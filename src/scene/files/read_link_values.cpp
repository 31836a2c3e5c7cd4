#include <algorithm>

#include "gpu_planning_scene/error.h"
#include "scene/files/scene_keys.h"
#include "scene/files/scene_reader.h"
#include "scene/missing_link.h"
#include "scene/solid_rules.h"

// Padding, scale and solids of links, and colours of bodies.
namespace gpu_planning_scene::core
{
namespace
{
/// Reads the list `key` of values by link. `kind`: its items. Links that it does not name have their default. Empty if
/// all values are `usual`.
std::vector<double> readLinkValues(const YamlValue& scene, const SceneReader& reader, const char* key, SceneMap kind,
                                   const std::string& member, const std::vector<double>& defaults, double usual)
{
  const YamlValue* list = scene.find(key);
  if (!list)
    return defaults;
  std::vector<double> values = defaults;
  values.resize(reader.robot.links().size(), usual);
  std::vector<bool> given(values.size(), false);
  for (const YamlValue& item : list->items())
  {
    checkKeys(item, kind, reader.warnings);
    const YamlValue& name = item.at("link_name");
    const YamlValue& value = item.at(member);
    const double number = value.number();
    const std::string what = "the " + member + " of link '" + name.text() + "'";
    if (number < 0.0 || (number == 0.0 && usual != 0.0))
      value.fail(what + (usual == 0.0 ? " is negative; it must be at least 0 m" : " must be above 0"));
    const int link = reader.robot.linkIndex(name.text());
    if (link < 0)
    {
      reader.warn(name.where() + ": " + member + " ignored: the robot " + noLinkText(reader.robot, name.text()));
      continue;
    }
    if (given[static_cast<std::size_t>(link)])
      name.fail(what + " is given twice");
    given[static_cast<std::size_t>(link)] = true;
    values[static_cast<std::size_t>(link)] = number;
  }
  const bool any = std::any_of(values.begin(), values.end(), [usual](double value) { return value != usual; });
  return any ? values : std::vector<double>();
}
}  // namespace

std::vector<double> readLinkPadding(const YamlValue& scene, const SceneReader& reader)
{
  return readLinkValues(scene, reader, "link_padding", SceneMap::LinkPadding, "padding", reader.defaults.link_padding,
                        0.0);
}

std::vector<double> readLinkScale(const YamlValue& scene, const SceneReader& reader)
{
  return readLinkValues(scene, reader, "link_scale", SceneMap::LinkScale, "scale", reader.defaults.link_scale, 1.0);
}

SolidRule readSolidRule(const YamlValue& value)
{
  const std::string name = value.text();
  try
  {
    return solidRuleFrom(name);
  }
  catch (const Error& error)
  {
    value.fail(error.what());
  }
}

std::map<std::string, SolidRule> readLinkSolids(const YamlValue& scene, const SceneReader& reader)
{
  std::map<std::string, SolidRule> rules;
  const YamlValue* list = scene.find("link_solid");
  if (!list)
    return rules;
  for (const YamlValue& item : list->items())
  {
    checkKeys(item, SceneMap::LinkSolid, reader.warnings);
    const YamlValue& name = item.at("link_name");
    const int link = reader.robot.linkIndex(name.text());
    if (link < 0)
      name.fail("the robot " + noLinkText(reader.robot, name.text()));
    if (!solidRuleOf(reader.robot.links()[static_cast<std::size_t>(link)].shapes))
      name.fail("link '" + name.text() + "' has no mesh; only meshes have a rule for their solid");
    if (!rules.emplace(name.text(), readSolidRule(item.at("solid"))).second)
      name.fail("the solid of link '" + name.text() + "' is given twice");
  }
  return rules;
}

std::map<std::string, Color> readColors(const YamlValue& scene, const SceneReader& reader)
{
  std::map<std::string, Color> colors;
  const YamlValue* list = scene.find("object_colors");
  if (!list)
    return colors;
  for (const YamlValue& item : list->items())
  {
    checkKeys(item, SceneMap::ObjectColor, reader.warnings);
    const YamlValue& value = item.at("color");
    checkKeys(value, SceneMap::Color, reader.warnings);
    const auto part = [&value](const char* key)
    {
      const double number = value.at(key).number();
      if (number < 0.0 || number > 1.0)
        value.fail("a color's components must be from 0 to 1");
      return static_cast<float>(number);
    };
    const YamlValue& id = item.at("id");
    if (!colors.emplace(id.text(), Color{part("r"), part("g"), part("b"), part("a")}).second)
      id.fail("the color of '" + id.text() + "' is given twice");
  }
  return colors;
}
}  // namespace gpu_planning_scene::core
