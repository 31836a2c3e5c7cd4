#include "gpu_planning_scene/planning_file.h"

#include "base/text/one_line.h"
#include "gpu_planning_scene/error.h"
#include "model/joint_limits_entry.h"
#include "scene/files/yaml_value.h"

namespace gpu_planning_scene::core
{
namespace
{
class JointLimitsReader
{
 public:
  JointLimitsReader(std::string source, std::vector<std::string>* warnings)
    : source_(std::move(source)), warnings_(warnings)
  {
  }

  std::vector<JointLimits> read(const YamlValue& file)
  {
    for (const auto& [key, value] : file.members())
    {
      if (const std::string meant = misspeltJointLimits(key); !meant.empty())
        value.fail("unknown key '" + key + "'" + meant);
      if (key != "joint_limits")
        requireNoLimits(key, value);
      if (key.compare(0, 8, "default_") == 0 && key.find("scaling_factor") == std::string::npos)
        warn(value.where() + ": '" + key + "' is not used here; only the node uses it");
    }
    if (const YamlValue* limits = file.find("joint_limits"))
      for (const auto& [name, entry] : limits->members())
        readEntry(name, entry);
    if (limits_.empty())
      warn(source_ + ": no limits: joint_limits has no min_position, max_position, max_velocity or max_acceleration");
    return std::move(limits_);
  }

 private:
  void warn(const std::string& line)
  {
    if (warnings_ != nullptr)
      warnings_->push_back(line);
  }

  /// Limits in another place would be lost.
  static void requireNoLimits(const std::string& key, const YamlValue& value)
  {
    if (value.kind() != YamlValue::Kind::Map)
      return;
    for (const auto& [inner, member] : value.members())
      if (inner == "joint_limits")
        member.fail("'joint_limits' is in '" + key + "'; it must be at the top of the file");
      else if (inner == "min_position" || inner == "max_position")
        member.fail("'" + key + "' has a position limit and is not in joint_limits; write joint_limits: {" + key +
                    ": {" + inner + ": ...}}");
      else
        requireNoLimits(inner, member);
  }

  /// The members are limits of the variable, or entries of the variables of a joint that has several.
  void readEntry(const std::string& name, const YamlValue& value)
  {
    if (value.kind() == YamlValue::Kind::Null)
      return;
    JointLimitsEntry entry{name};
    for (const auto& [key, member] : value.members())
      if (member.kind() == YamlValue::Kind::Map)
        readEntry(name + "/" + key, member);
      else if (const JointLimitsMember limit = memberOf(entry, key); limit.flag)
        *limit.flag = member.boolean();
      else if (limit.number)
        *limit.number = member.number();
      else if (const std::string meant = misspeltLimit(key); !meant.empty())
        member.fail("'" + name + "': unknown key '" + key + "'" + meant);
    if (std::optional<JointLimits> limits = jointLimitsOf(entry, source_, warnings_))
      limits_.push_back(std::move(*limits));
  }

  const std::string source_;
  std::vector<std::string>* const warnings_;
  std::vector<JointLimits> limits_;
};

std::vector<JointLimits> read(const YamlValue& file, const std::string& name, std::vector<std::string>* warnings)
{
  return JointLimitsReader(name, warnings).read(file);
}
}  // namespace

std::vector<JointLimits> readJointLimits(const std::string& path, std::vector<std::string>* warnings)
{
  try
  {
    return read(YamlValue::loadFile(path), path, warnings);
  }
  catch (const Error& error)
  {
    throw Error(onOneLine(error.what()));
  }
}

std::vector<JointLimits> jointLimitsFromText(const std::string& text, const std::string& name,
                                             std::vector<std::string>* warnings)
{
  try
  {
    return read(YamlValue::fromText(text, name), name, warnings);
  }
  catch (const Error& error)
  {
    throw Error(onOneLine(error.what()));
  }
}
}  // namespace gpu_planning_scene::core
