#include "model/description/srdf_reader.h"

#include <tinyxml2.h>

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

std::vector<SrdfName> readNames(const XmlText& xml, const tinyxml2::XMLElement& parent, const char* tag,
                                const char* attribute = "name")
{
  std::vector<SrdfName> names;
  forEachChild(parent, tag,
               [&](const tinyxml2::XMLElement& element) {
                 names.push_back({xml.attribute(element, attribute), xml.where(element)});
               });
  return names;
}

std::vector<SrdfPair> readPairs(const XmlText& xml, const char* tag)
{
  std::vector<SrdfPair> pairs;
  forEachChild(xml.root(), tag,
               [&](const tinyxml2::XMLElement& element)
               {
                 const char* reason = element.Attribute("reason");
                 pairs.push_back({xml.attribute(element, "link1"), xml.attribute(element, "link2"),
                                  reason == nullptr ? "" : reason, xml.where(element)});
               });
  return pairs;
}

SrdfGroup readGroup(const XmlText& xml, const tinyxml2::XMLElement& element)
{
  SrdfGroup group;
  group.name = xml.attribute(element, "name");
  group.where = xml.where(element);
  group.joints = readNames(xml, element, "joint");
  group.links = readNames(xml, element, "link");
  group.subgroups = readNames(xml, element, "group");
  forEachChild(
      element, "chain",
      [&](const tinyxml2::XMLElement& chain) {
        group.chains.push_back({xml.attribute(chain, "base_link"), xml.attribute(chain, "tip_link"), xml.where(chain)});
      });
  return group;
}

SrdfNamedState readNamedState(const XmlText& xml, const tinyxml2::XMLElement& element)
{
  SrdfNamedState state = {xml.attribute(element, "name"), xml.attribute(element, "group"), xml.where(element), {}};
  forEachChild(element, "joint",
               [&](const tinyxml2::XMLElement& joint)
               {
                 state.values.emplace_back(SrdfName{xml.attribute(joint, "name"), xml.where(joint)},
                                           xml.attribute(joint, "value"));
               });
  return state;
}

SrdfVirtualJoint readVirtualJoint(const XmlText& xml, const tinyxml2::XMLElement& element)
{
  SrdfVirtualJoint joint = {xml.attribute(element, "name"), xml.attribute(element, "type"),
                            xml.attribute(element, "parent_frame"), xml.attribute(element, "child_link"),
                            xml.where(element)};
  if (joint.type != "fixed" && joint.type != "planar" && joint.type != "floating")
  {
    throw Error(joint.where + ": virtual joint '" + joint.name + "' is of type '" + joint.type +
                "', it must be fixed, planar or floating");
  }
  return joint;
}
}  // namespace

Srdf readSrdf(const std::string& text, const std::string& name)
{
  const XmlText xml(text, name, "robot");
  requireSrdf(xml);
  Srdf srdf;
  const char* robot_name = xml.root().Attribute("name");
  srdf.robot_name = robot_name == nullptr ? "" : robot_name;
  srdf.where = xml.where(xml.root());
  forEachChild(
      xml.root(), "virtual_joint",
      [&](const tinyxml2::XMLElement& element) { srdf.virtual_joints.push_back(readVirtualJoint(xml, element)); });
  forEachChild(
      xml.root(), "group",
      [&](const tinyxml2::XMLElement& element) { srdf.groups.push_back(readGroup(xml, element)); });
  forEachChild(xml.root(), "group_state",
               [&](const tinyxml2::XMLElement& element) { srdf.named_states.push_back(readNamedState(xml, element)); });
  srdf.passive_joints = readNames(xml, xml.root(), "passive_joint");
  srdf.disabled = readPairs(xml, "disable_collisions");
  srdf.enabled = readPairs(xml, "enable_collisions");
  srdf.disabled_by_default = readNames(xml, xml.root(), "disable_default_collisions", "link");
  return srdf;
}
}  // namespace gpu_planning_scene::core
