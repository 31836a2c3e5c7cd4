#include "planners/planner_configs.h"

#include <algorithm>
#include <sstream>

#include <ros/console.h>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using XmlRpc::XmlRpcValue;

const XmlRpcValue& requireType(const XmlRpcValue& value, XmlRpcValue::Type type, const std::string& name,
                               const char* what)
{
  if (value.getType() != type)
    throw Error("parameter " + name + " must be " + what);
  return value;
}

std::string textOf(XmlRpcValue value, const std::string& name)
{
  std::ostringstream text;
  text.precision(17);
  switch (value.getType())
  {
    case XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    case XmlRpcValue::TypeInt:
      text << static_cast<int>(value);
      return text.str();
    case XmlRpcValue::TypeDouble:
      text << static_cast<double>(value);
      return text.str();
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "1" : "0";
    default:
      throw Error("parameter " + name + " must be a text or a number");
  }
}

PlannerConfig configOf(XmlRpcValue& value, const std::string& name)
{
  requireType(value, XmlRpcValue::TypeStruct, name, "a map: type and the planner's parameters");
  PlannerConfig config;
  for (auto& [key, entry] : value)
  {
    const std::string text = textOf(entry, name + "/" + key);
    if (key == "type")
      config.type = text;
    else
      config.parameters[key] = text;
  }
  if (config.type.empty())
    throw Error("parameter " + name + "/type is missing; it names a planner, such as geometric::RRTConnect");
  return config;
}

/// joints(A,B,...)
std::vector<std::string> projectionOf(const std::string& text, const std::string& name)
{
  const std::string begin = "joints(";
  if (text.rfind(begin, 0) != 0 || text.back() != ')')
    throw Error("parameter " + name + " is '" + text + "'; it must be joints(NAME,...)");
  std::istringstream list(text.substr(begin.size(), text.size() - begin.size() - 1));
  std::vector<std::string> joints;
  for (std::string joint; std::getline(list, joint, ',');)
  {
    joint.erase(std::remove(joint.begin(), joint.end(), ' '), joint.end());
    joints.push_back(joint);
  }
  return joints;
}

GroupPlanners groupOf(XmlRpcValue& value, const std::string& name)
{
  requireType(value, XmlRpcValue::TypeStruct, name, "a map");
  GroupPlanners group;
  for (auto& [key, entry] : value)
  {
    const std::string full = name + "/" + key;
    if (key == "default_planner_config")
      group.default_config = textOf(entry, full);
    else if (key == "projection_evaluator")
      group.projection = projectionOf(textOf(entry, full), full);
    else if (key == "longest_valid_segment_fraction")
    {
      const double fraction = entry.getType() == XmlRpcValue::TypeDouble ? static_cast<double>(entry)
                              : entry.getType() == XmlRpcValue::TypeInt  ? static_cast<int>(entry)
                                                                         : 0.0;
      if (!(fraction > 0.0 && fraction <= 1.0))
        throw Error("parameter " + full + " must be a number above 0 and at most 1");
      group.longest_valid_segment_fraction = fraction;
    }
    else if (key == "planner_configs")
    {
      requireType(entry, XmlRpcValue::TypeArray, full, "a list of names");
      for (int i = 0; i < entry.size(); ++i)
        group.configs.push_back(textOf(entry[i], full));
    }
    else
      ROS_WARN_STREAM("parameter " << full
                                   << " is not used; a group has default_planner_config, planner_configs, "
                                      "projection_evaluator and longest_valid_segment_fraction");
  }
  return group;
}
}  // namespace

PlannerConfigs PlannerConfigs::fromParameters(const ros::NodeHandle& own)
{
  XmlRpcValue planners;
  if (!own.getParam("planners", planners))
    return {};
  return fromValue(planners, own.resolveName("planners"));
}

PlannerConfigs PlannerConfigs::fromValue(XmlRpcValue& planners, const std::string& name)
{
  PlannerConfigs result;
  requireType(planners, XmlRpcValue::TypeStruct, name, "a map in the format of MoveIt's ompl_planning.yaml");
  for (auto& [key, value] : planners)
  {
    if (key != "planner_configs")
    {
      result.groups_[key] = groupOf(value, name + "/" + key);
      continue;
    }
    requireType(value, XmlRpcValue::TypeStruct, name + "/planner_configs", "a map of planners");
    for (auto& [config, entry] : value)
      result.configs_[config] = configOf(entry, name + "/planner_configs/" + config);
  }
  for (const auto& [group, planners_of_group] : result.groups_)
  {
    std::vector<std::string> named = planners_of_group.configs;
    if (!planners_of_group.default_config.empty())
      named.push_back(planners_of_group.default_config);
    for (const std::string& config : named)
      if (result.configs_.count(config) == 0)
        throw Error("parameter " + name + "/" + group + " names the planner '" + config + "', which is not in " + name +
                    "/planner_configs");
  }
  return result;
}

PlannerConfig PlannerConfigs::find(const std::string& name, const std::string& group) const
{
  const GroupPlanners& of_group = ofGroup(group);
  const std::string& wanted = name.empty() ? of_group.default_config : name;
  if (wanted.empty())
    return {kBatchPlanner, {}};
  const auto config = configs_.find(wanted);
  if (config == configs_.end())
    return {wanted, {}};
  const std::vector<std::string>& meant = of_group.configs;
  if (!meant.empty() && wanted != of_group.default_config &&
      std::find(meant.begin(), meant.end(), wanted) == meant.end())
    throw Error("planner '" + wanted + "' is not among the planner_configs of group '" + group + "'");
  return config->second;
}

std::vector<std::string> PlannerConfigs::names() const
{
  std::vector<std::string> names;
  for (const auto& [name, config] : configs_)
    names.push_back(name);
  return names;
}

const GroupPlanners& PlannerConfigs::ofGroup(const std::string& group) const
{
  static const GroupPlanners none;
  const auto found = groups_.find(group);
  return found == groups_.end() ? none : found->second;
}
}  // namespace gpu_planning_scene::core
