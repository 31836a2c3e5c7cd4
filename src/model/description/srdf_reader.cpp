#include "model/description/srdf_reader.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>

#include <tinyxml2.h>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "model/description/xml_kind.h"

namespace gpu_planning_scene::core
{
namespace
{
template <typename Function>
void forEachChild(const tinyxml2::XMLElement& parent, const char* tag, Function function)
{
  for (const auto* child = parent.FirstChildElement(tag); child != nullptr; child = child->NextSiblingElement(tag))
    function(*child);
}

/// MoveIt leaves out blanks around names.
std::string trimmed(const std::string& text)
{
  const char* const blanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

class SrdfReader
{
 public:
  SrdfReader(const XmlText& xml, std::vector<std::string>& warnings) : xml_(xml), warnings_(warnings) {}

  Srdf read()
  {
    checkNames();
    const tinyxml2::XMLElement& root = xml_.root();
    Srdf srdf;
    const char* robot_name = root.Attribute("name");
    srdf.robot_name = robot_name == nullptr ? "" : trimmed(robot_name);
    srdf.where = xml_.where(root);
    forEachChild(
        root, "virtual_joint",
        [&](const tinyxml2::XMLElement& element) { srdf.virtual_joints.push_back(readVirtualJoint(element)); });
    forEachChild(
        root, "group",
        [&](const tinyxml2::XMLElement& element)
        {
          if (hasAll(element, {"name"}))
            srdf.groups.push_back(readGroup(element));
        });
    forEachChild(root, "group_state",
                 [&](const tinyxml2::XMLElement& element)
                 {
                   if (hasAll(element, {"name", "group"}))
                     srdf.named_states.push_back(readNamedState(element));
                 });
    srdf.passive_joints = readNames(root, "passive_joint");
    forEachChild(
        root, "joint_property",
        [&](const tinyxml2::XMLElement& element)
        {
          if (hasAll(element, {"joint_name", "property_name", "value"}))
            srdf.joint_properties.push_back({attribute(element, "joint_name"), attribute(element, "property_name"),
                                             attribute(element, "value"), xml_.where(element)});
        });
    forEachChild(
        root, "disable_collisions",
        [&](const tinyxml2::XMLElement& element)
        {
          if (hasAll(element, {"link1", "link2"}))
            srdf.disabled.push_back(readPair(element));
        });
    forEachChild(root, "enable_collisions",
                 [&](const tinyxml2::XMLElement& element) { srdf.enabled.push_back(readPair(element)); });
    srdf.disabled_by_default = readNames(root, "disable_default_collisions", "link");
    return srdf;
  }

 private:
  /// The trimmed value of an attribute; throws Error if the element lacks it.
  std::string attribute(const tinyxml2::XMLElement& element, const char* name) const
  {
    return trimmed(xml_.attribute(element, name));
  }

  /// Whether an element has these attributes. If not, there is a warning.
  bool hasAll(const tinyxml2::XMLElement& element, std::initializer_list<const char*> names)
  {
    for (const char* name : names)
      if (element.Attribute(name) == nullptr)
      {
        const char* const own = element.Attribute("name");
        warnings_.push_back(xml_.where(element) + ": <" + element.Name() + (own == nullptr ? "" : " name=\"") +
                            (own == nullptr ? "" : std::string(own) + "\"") + "> lacks the attribute '" + name +
                            "'; it is left out");
        return false;
      }
    return true;
  }

  /// Refuses misspelt elements whose loss would move the robot or leave pairs unchecked, and warns of others. Unknown
  /// elements that are similar to no known one belong to other programs.
  void checkNames()
  {
    static const std::vector<std::string> known = {"virtual_joint",
                                                   "group",
                                                   "group_state",
                                                   "end_effector",
                                                   "passive_joint",
                                                   "disable_collisions",
                                                   "enable_collisions",
                                                   "disable_default_collisions",
                                                   "link_sphere_approximation",
                                                   "joint_property"};
    static const std::vector<std::string> of_group = {"joint", "link", "chain", "group", "passive_joint"};
    for (const auto* element = xml_.root().FirstChildElement(); element != nullptr;
         element = element->NextSiblingElement())
    {
      const std::string name = element->Name();
      if (name == "group")
        for (const auto* child = element->FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
          checkName(*child, of_group, {"joint", "link", "chain", "group"});
      else if (name == "group_state")
        for (const auto* child = element->FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
          checkName(*child, {"joint"}, {});
      else
        checkName(*element, known, {"virtual_joint", "group", "enable_collisions"});
    }
  }

  void checkName(const tinyxml2::XMLElement& element, const std::vector<std::string>& known,
                 const std::vector<std::string>& needed)
  {
    const std::string name = element.Name();
    const std::string meant = contains(known, name) ? "" : meantName(name, known);
    if (meant.empty())
      return;
    const std::string text = xml_.where(element) + ": unknown element <" + name + ">; did you mean <" + meant + ">?";
    if (contains(needed, meant))
      throw Error(text);
    warnings_.push_back(text + " It is left out");
  }

  std::vector<SrdfName> readNames(const tinyxml2::XMLElement& parent, const char* tag, const char* name = "name")
  {
    std::vector<SrdfName> names;
    forEachChild(parent, tag,
                 [&](const tinyxml2::XMLElement& element)
                 {
                   if (hasAll(element, {name}))
                     names.push_back({attribute(element, name), xml_.where(element)});
                 });
    return names;
  }

  SrdfPair readPair(const tinyxml2::XMLElement& element) const
  {
    const char* reason = element.Attribute("reason");
    return {attribute(element, "link1"), attribute(element, "link2"), reason == nullptr ? "" : reason,
            xml_.where(element)};
  }

  SrdfGroup readGroup(const tinyxml2::XMLElement& element)
  {
    SrdfGroup group;
    group.name = attribute(element, "name");
    group.where = xml_.where(element);
    group.joints = readNames(element, "joint");
    group.links = readNames(element, "link");
    group.subgroups = readNames(element, "group");
    forEachChild(
        element, "chain",
        [&](const tinyxml2::XMLElement& chain)
        {
          if (hasAll(chain, {"base_link", "tip_link"}))
            group.chains.push_back({attribute(chain, "base_link"), attribute(chain, "tip_link"), xml_.where(chain)});
        });
    return group;
  }

  SrdfNamedState readNamedState(const tinyxml2::XMLElement& element)
  {
    SrdfNamedState state = {attribute(element, "name"), attribute(element, "group"), xml_.where(element), {}};
    forEachChild(
        element, "joint",
        [&](const tinyxml2::XMLElement& joint)
        {
          if (hasAll(joint, {"name", "value"}))
            state.values.emplace_back(SrdfName{attribute(joint, "name"), xml_.where(joint)}, attribute(joint, "value"));
        });
    return state;
  }

  SrdfVirtualJoint readVirtualJoint(const tinyxml2::XMLElement& element) const
  {
    SrdfVirtualJoint joint = {attribute(element, "name"), attribute(element, "type"),
                              attribute(element, "parent_frame"), attribute(element, "child_link"),
                              xml_.where(element)};
    const std::string given = joint.type;
    std::transform(joint.type.begin(), joint.type.end(), joint.type.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (joint.type != "fixed" && joint.type != "planar" && joint.type != "floating")
    {
      throw Error(joint.where + ": virtual joint '" + joint.name + "' is of type '" + given +
                  "', it must be fixed, planar or floating");
    }
    return joint;
  }

  const XmlText& xml_;
  std::vector<std::string>& warnings_;
};
}  // namespace

Srdf readSrdf(const std::string& text, const std::string& name, std::vector<std::string>& warnings)
{
  const XmlText xml(text, name, "robot");
  requireSrdf(xml);
  return SrdfReader(xml, warnings).read();
}
}  // namespace gpu_planning_scene::core
