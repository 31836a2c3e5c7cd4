#pragma once

#include <memory>
#include <string>
#include <vector>

namespace tinyxml2
{
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace gpu_planning_scene::core
{
/// A parsed XML text that can tell the line of an element, for messages.
class XmlText
{
 public:
  /// `name`: the file or parameter of the text. Throws Error with name and line if the text is malformed or its root
  /// element is not `root`.
  XmlText(const std::string& text, const std::string& name, const std::string& root);

  const std::string& name() const { return name_; }
  const tinyxml2::XMLElement& root() const { return *root_; }
  /// Place of an element, as "NAME:LINE".
  std::string where(const tinyxml2::XMLElement& element) const;
  /// Place of the first element <tag name="value"> below the root; NAME alone if there is none.
  std::string where(const std::string& tag, const std::string& value) const;
  /// True if that element has a child <child_tag>.
  bool hasChild(const std::string& tag, const std::string& value, const char* child_tag) const;
  /// The value of an attribute; throws Error if the element lacks it.
  std::string attribute(const tinyxml2::XMLElement& element, const char* attribute) const;

 private:
  const tinyxml2::XMLElement* find(const std::string& tag, const std::string& value) const;

  std::string name_;
  std::shared_ptr<tinyxml2::XMLDocument> document_;
  const tinyxml2::XMLElement* root_;
};

/// The name of `known` that a misspelt element or attribute means: it differs in upper case, hyphens or underscores, or
/// by few typing errors. Empty if there is none, and for names with a prefix, such as drake:capsule.
std::string meantName(const std::string& name, const std::vector<std::string>& known);
}  // namespace gpu_planning_scene::core
