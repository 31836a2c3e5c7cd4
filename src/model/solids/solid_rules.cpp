#include <algorithm>
#include <map>
#include <utility>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/robot_model.h"

// Rules for the solids of meshes: their names, and robots with other rules.
namespace gpu_planning_scene::core
{
SolidRule solidRuleFrom(const std::string& name)
{
  if (name == "auto")
    return SolidRule::Auto;
  if (name == "surface")
    return SolidRule::Surface;
  if (name == "filled")
    return SolidRule::Filled;
  throw Error("solid: '" + name + "' is unknown; known are auto, surface and filled");
}

std::string toString(SolidRule rule)
{
  return rule == SolidRule::Auto ? "auto" : rule == SolidRule::Surface ? "surface" : "filled";
}

bool setSolidRule(std::vector<PlacedShape>& shapes, SolidRule rule)
{
  std::map<const Mesh*, std::shared_ptr<const Mesh>> changed;
  for (PlacedShape& placed : shapes)
  {
    auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape);
    if (!mesh || (*mesh)->solid == rule)
      continue;
    std::shared_ptr<const Mesh>& known = changed[mesh->get()];
    if (!known)
    {
      auto copy = std::make_shared<Mesh>(**mesh);
      copy->solid = rule;
      known = std::move(copy);
    }
    *mesh = known;
  }
  return !changed.empty();
}

std::shared_ptr<const RobotModel> RobotModel::withSolids(const std::map<std::string, SolidRule>& rules) const
{
  const std::shared_ptr<const RobotModel> loaded = as_loaded_ ? as_loaded_ : shared_from_this();
  const auto result = std::make_shared<RobotModel>(*loaded);
  bool is_changed = false;
  for (const auto& [name, rule] : rules)
  {
    const int link = linkIndex(name);
    if (link < 0)
    {
      std::vector<std::string> names;
      for (const Link& each : links_)
        names.push_back(each.name);
      throw Error("solid of link '" + name + "': the robot has no such link; it has " + nameList(names));
    }
    std::vector<PlacedShape>& shapes = result->links_[static_cast<std::size_t>(link)].shapes;
    if (std::none_of(shapes.begin(), shapes.end(),
                     [](const PlacedShape& placed)
                     { return std::holds_alternative<std::shared_ptr<const Mesh>>(placed.shape); }))
      throw Error("solid of link '" + name + "': the link has no mesh; only meshes have a rule for their solid");
    is_changed = setSolidRule(shapes, rule) || is_changed;
  }
  if (!is_changed)
    return shared_from_this();
  return link_scale_.empty() ? result : result->scaled(link_scale_);
}
}  // namespace gpu_planning_scene::core
