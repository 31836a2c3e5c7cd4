#include "node/parameters/joint_limits_parameter.h"

#include "gpu_planning_scene/error.h"
#include "model/joint_limits_entry.h"

namespace gpu_planning_scene::core
{
namespace
{
using XmlRpc::XmlRpcValue;

/// `name`: of the parameter, for messages.
double numberFrom(const XmlRpcValue& value, const std::string& name)
{
  XmlRpcValue copy = value;  // XmlRpcValue has no const access
  if (copy.getType() == XmlRpcValue::TypeInt)
    return static_cast<int>(copy);
  if (copy.getType() != XmlRpcValue::TypeDouble)
    throw Error("parameter " + name + " is not a number");
  return static_cast<double>(copy);
}

bool flagFrom(const XmlRpcValue& value, const std::string& name)
{
  XmlRpcValue copy = value;
  if (copy.getType() != XmlRpcValue::TypeBoolean)
    throw Error("parameter " + name + " is not true or false");
  return static_cast<bool>(copy);
}

class LimitsReader
{
 public:
  LimitsReader(std::string folder, std::vector<std::string>* warnings) : folder_(std::move(folder)), warnings_(warnings)
  {
  }

  std::vector<JointLimits> read(const XmlRpcValue& joints)
  {
    requireMap(joints, folder_);
    for (const auto& [name, entry] : joints)
      readEntry(name, entry);
    return std::move(limits_);
  }

 private:
  static void requireMap(const XmlRpcValue& value, const std::string& name)
  {
    if (value.getType() != XmlRpcValue::TypeStruct)
      throw Error("parameter " + name + " is not a map; write {JOINT: {min_position: NUMBER, max_position: NUMBER}}");
  }

  /// The members are limits of the variable, or entries of the variables of a joint that has several.
  void readEntry(const std::string& variable, const XmlRpcValue& value)
  {
    requireMap(value, folder_ + "/" + variable);
    JointLimitsEntry entry{variable};
    for (const auto& [key, member] : value)
    {
      const std::string name = folder_ + "/" + variable + "/" + key;
      if (member.getType() == XmlRpcValue::TypeStruct)
        readEntry(variable + "/" + key, member);
      else if (const JointLimitsMember limit = memberOf(entry, key); limit.flag)
        *limit.flag = flagFrom(member, name);
      else if (limit.number)
        *limit.number = numberFrom(member, name);
      else if (const std::string meant = misspeltLimit(key); !meant.empty())
        throw Error("parameter " + name + ": unknown key" + meant);
    }
    if (std::optional<JointLimits> limits = jointLimitsOf(entry, "parameter " + folder_, warnings_))
      limits_.push_back(std::move(*limits));
  }

  const std::string folder_;  // name of the parameter joint_limits
  std::vector<std::string>* const warnings_;
  std::vector<JointLimits> limits_;
};
}  // namespace

std::vector<JointLimits> jointLimitsFromParameters(const ros::NodeHandle& node, const std::string& folder,
                                                   std::vector<std::string>* warnings)
{
  XmlRpcValue parameters;
  if (!node.getParam(folder, parameters) || parameters.getType() != XmlRpcValue::TypeStruct)
    return {};
  const std::string name = node.resolveName(folder);
  for (const auto& [key, value] : parameters)
    if (const std::string meant = misspeltJointLimits(key); !meant.empty())
      throw Error("parameter " + name + "/" + key + ": unknown key" + meant);
  return parameters.hasMember("joint_limits")
             ? LimitsReader(name + "/joint_limits", warnings).read(parameters["joint_limits"])
             : std::vector<JointLimits>();
}
}  // namespace gpu_planning_scene::core
