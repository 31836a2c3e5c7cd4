#include "model/description/xml_kind.h"

#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <system_error>

#include <tinyxml2.h>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using tinyxml2::XMLElement;

bool isXacro(const XMLElement& element)
{
  return std::strncmp(element.Name(), "xacro:", 6) == 0;
}

/// Whether the robot is incomplete or wrong if xacro has not expanded this element. Properties and arguments are
/// harmless: expressionOf finds their uses.
bool isDirective(const XMLElement& element)
{
  for (const char* name : {"include", "macro", "if", "unless", "insert_block", "element", "attribute"})
    if (isXacro(element) && std::strcmp(element.Name() + 6, name) == 0)
      return true;
  return false;
}

/// An attribute with an expression that xacro would have replaced; null if there is none.
const tinyxml2::XMLAttribute* expressionOf(const XMLElement& element)
{
  for (const auto* attribute = element.FirstAttribute(); attribute != nullptr; attribute = attribute->Next())
    if (std::strstr(attribute->Value(), "${") != nullptr || std::strstr(attribute->Value(), "$(") != nullptr)
      return attribute;
  return nullptr;
}

/// The file of a text, as the commands of a message name it: in quotes, because a path may have spaces. FILE if the
/// text comes from no file of this machine, or if the quotes would not do.
std::string fileOf(const XmlText& xml)
{
  std::error_code failure;
  const bool is_file = std::filesystem::is_regular_file(xml.name(), failure);
  return is_file && xml.name().find_first_of("'\"$`\\!") == std::string::npos ? "'" + xml.name() + "'" : "FILE";
}

/// The first element that xacro must expand; null if there is none.
const XMLElement* firstXacro(const XMLElement& element)
{
  if (expressionOf(element) != nullptr || isDirective(element))
    return &element;
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    if (const XMLElement* found = firstXacro(*child))
      return found;
  return nullptr;
}

void findLeftovers(const XMLElement& element, std::vector<const XMLElement*>& leftovers)
{
  if (isXacro(element))
    leftovers.push_back(&element);
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    findLeftovers(*child, leftovers);
}

/// `kind`: "urdf" or "srdf". `leftovers` receives all other elements of xacro.
void refuseXacro(const XmlText& xml, const std::string& kind, std::vector<const XMLElement*>& leftovers)
{
  if (const XMLElement* element = firstXacro(xml.root()))
  {
    const auto* expression = expressionOf(*element);
    const std::string command = "xacro " + fileOf(xml);
    throw Error(xml.where(*element) + ": " +
                (expression != nullptr ? std::string(expression->Name()) + "=\"" + expression->Value() + "\""
                                       : std::string("<") + element->Name() + ">") +
                " is xacro, which must be expanded first: " + command + " > expanded." + kind +
                ", or for the launch file " + kind + "_command:=\"" + command + "\" instead of " + kind + ":=FILE");
  }
  findLeftovers(xml.root(), leftovers);
}

const XMLElement* firstOf(const XmlText& xml, std::initializer_list<const char*> tags)
{
  for (const char* tag : tags)
    if (const XMLElement* child = xml.root().FirstChildElement(tag))
      return child;
  return nullptr;
}
}  // namespace

bool needsXacro(const XmlText& xml)
{
  return firstXacro(xml.root()) != nullptr;
}

void requireUrdf(const XmlText& xml, std::vector<std::string>& warnings)
{
  std::vector<const XMLElement*> leftovers;
  refuseXacro(xml, "urdf", leftovers);
  for (const XMLElement* element : leftovers)
    warnings.push_back(xml.where(*element) + ": <" + element->Name() +
                       "> was not expanded by xacro: what the macro makes, for example links, is missing");
  const XMLElement* of_srdf =
      firstOf(xml, {"group", "disable_collisions", "virtual_joint", "end_effector", "group_state", "passive_joint"});
  if (firstOf(xml, {"link"}) == nullptr && of_srdf != nullptr)
    throw Error(xml.where(*of_srdf) + ": <" + of_srdf->Name() +
                "> without any <link>: this is an SRDF, and a URDF is needed here; give the SRDF as srdf:=FILE (launch "
                "file), --srdf FILE (tools) or in robot_description_semantic");
}

void requireSrdf(const XmlText& xml)
{
  std::vector<const XMLElement*> leftovers;
  refuseXacro(xml, "srdf", leftovers);
  if (!leftovers.empty())
    throw Error(xml.where(*leftovers[0]) + ": <" + leftovers[0]->Name() +
                "> was not expanded by xacro; expand the file with all that it includes: xacro " + fileOf(xml) +
                " > expanded.srdf");
  if (const XMLElement* of_urdf = firstOf(xml, {"link", "joint"}))
    throw Error(xml.where(*of_urdf) + ": <" + of_urdf->Name() +
                "> is an element of a URDF, and an SRDF is needed here; give the URDF as urdf:=FILE (launch file), "
                "--urdf FILE (tools) or in robot_description");
}
}  // namespace gpu_planning_scene::core
