#include <set>

#include "scene/files/scene_reader.h"
#include "scene/has_body.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The values of a matrix row: the bare row, or `enabled` of MoveIt's AllowedCollisionEntry.
const YamlValue& rowValues(const YamlValue& row, std::size_t count)
{
  const YamlValue& values = row.kind() == YamlValue::Kind::Map ? row.at("enabled") : row;
  if (values.items().size() != count)
    values.fail("a row of " + std::to_string(values.items().size()) + " entries for " + std::to_string(count) +
                " entry_names");
  return values;
}

const std::vector<YamlValue>& itemsOrNone(const YamlValue* value)
{
  static const std::vector<YamlValue> none;
  return value ? value->items() : none;
}
}  // namespace

bool readMatrix(const YamlValue& value, const SceneReader& reader, AllowedCollisionMatrix& matrix)
{
  value.warnOfUnknownKeys({"entry_names", "entry_values", "default_entry_names", "default_entry_values"},
                          reader.warnings);
  const auto& names = itemsOrNone(value.find("entry_names"));
  const auto& rows = itemsOrNone(value.find("entry_values"));
  const auto& default_names = itemsOrNone(value.find("default_entry_names"));
  const auto& default_values = itemsOrNone(value.find("default_entry_values"));
  if (rows.size() != names.size())
    value.fail(std::to_string(rows.size()) + " entry_values for " + std::to_string(names.size()) + " entry_names");
  if (default_values.size() != default_names.size())
    value.fail(std::to_string(default_values.size()) + " default_entry_values for " +
               std::to_string(default_names.size()) + " default_entry_names");
  if (names.empty() && default_names.empty())
    return false;

  std::set<std::string> seen;
  for (const YamlValue& name : names)
    if (!seen.insert(name.text()).second)
      name.fail("'" + name.text() + "' is in entry_names twice");

  AllowedCollisionMatrix result;
  std::vector<std::vector<bool>> allowed;
  for (const YamlValue& row : rows)
  {
    allowed.emplace_back();
    for (const YamlValue& entry : rowValues(row, names.size()).items())
      allowed.back().push_back(entry.boolean());
  }
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    for (std::size_t j = i + 1; j < names.size(); ++j)
    {
      if (allowed[i][j] != allowed[j][i])
        rows[j].fail("the matrix is not symmetric for '" + names[i].text() + "' and '" + names[j].text() + "'");
      result.setEntry(names[i].text(), names[j].text(), allowed[i][j]);
    }
  }
  for (std::size_t i = 0; i < default_names.size(); ++i)
    result.setDefault(default_names[i].text(), default_values[i].boolean());
  matrix = std::move(result);
  return true;
}

void addAllowedCollisions(const YamlValue& value, const SceneReader& reader, PlanningScene& scene)
{
  for (const YamlValue& pair : value.items())
  {
    const std::vector<YamlValue>& names = pair.items();
    if (names.size() != 2 || names[0].text() == names[1].text())
      pair.fail("allowed_collisions is a list of pairs of two names, for example [[can, table]]");
    for (const YamlValue& name : names)
      if (!hasBody(scene, name.text()))
        reader.warn(name.where() + ": allowed_collisions: '" + name.text() +
                    "' is neither a link nor an object of this scene; correct the name, unless an object of that name "
                    "will be added later");
    scene.allowed_collisions.setEntry(names[0].text(), names[1].text(), true);
    scene.matrix_source = MatrixSource::SceneFile;
  }
}
}  // namespace gpu_planning_scene::core
