#include "model/description/xml.h"

#include <algorithm>
#include <cctype>

#include <tinyxml2.h>

#include "base/text/nearest_key.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
// Turns XML_ERROR_MISMATCHED_ELEMENT into "mismatched element".
std::string readable(std::string error_name)
{
  const std::string prefix = "XML_ERROR_";
  if (error_name.compare(0, prefix.size(), prefix) == 0)
    error_name.erase(0, prefix.size());
  std::transform(error_name.begin(), error_name.end(), error_name.begin(),
                 [](unsigned char c) { return c == '_' ? ' ' : static_cast<char>(std::tolower(c)); });
  return error_name;
}
}  // namespace

XmlText::XmlText(const std::string& text, const std::string& name, const std::string& root)
  : name_(name), document_(std::make_shared<tinyxml2::XMLDocument>())
{
  if (document_->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
  {
    throw Error(name + ":" + std::to_string(std::max(1, document_->ErrorLineNum())) + ": malformed XML (" +
                readable(document_->ErrorName()) + ")");
  }
  root_ = document_->RootElement();
  if (root_ == nullptr)
    throw Error(name + ": malformed XML (no element)");
  if (root_->Name() != root)
    throw Error(where(*root_) + ": the root element is <" + root_->Name() + ">, it must be <" + root + ">");
}

std::string XmlText::where(const tinyxml2::XMLElement& element) const
{
  return name_ + ":" + std::to_string(element.GetLineNum());
}

const tinyxml2::XMLElement* XmlText::find(const std::string& tag, const std::string& value) const
{
  for (const auto* element = root_->FirstChildElement(tag.c_str()); element != nullptr;
       element = element->NextSiblingElement(tag.c_str()))
    if (element->Attribute("name", value.c_str()) != nullptr)
      return element;
  return nullptr;
}

std::string XmlText::where(const std::string& tag, const std::string& value) const
{
  const tinyxml2::XMLElement* element = find(tag, value);
  return element == nullptr ? name_ : where(*element);
}

bool XmlText::hasChild(const std::string& tag, const std::string& value, const char* child_tag) const
{
  const tinyxml2::XMLElement* element = find(tag, value);
  return element != nullptr && element->FirstChildElement(child_tag) != nullptr;
}

std::string XmlText::attribute(const tinyxml2::XMLElement& element, const char* attribute) const
{
  const char* value = element.Attribute(attribute);
  if (value == nullptr)
    throw Error(where(element) + ": <" + element.Name() + "> lacks the attribute '" + attribute + "'");
  return value;
}

std::string meantName(const std::string& name, const std::vector<std::string>& known)
{
  return name.find(':') == std::string::npos ? nearestSpelling(name, known) : "";
}
}  // namespace gpu_planning_scene::core
