#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tinyxml2.h>

namespace gpu_planning_scene::core
{
/// The XML of a COLLADA file.
class ColladaDocument
{
 public:
  /// Throws Error if the text is malformed or its root element is not <COLLADA>.
  explicit ColladaDocument(std::string_view text);

  const tinyxml2::XMLElement& root() const { return *document_.RootElement(); }

  /// The element of one kind with the id that an attribute names as "#ID". Throws Error if it is not in this file.
  const tinyxml2::XMLElement& target(const tinyxml2::XMLElement& element, const char* attribute,
                                     const std::string& kind) const;

 private:
  void collect(const tinyxml2::XMLElement& element);

  tinyxml2::XMLDocument document_;
  /// By kind and id. Some programs give elements of different kinds the same id. Null: two elements of a kind have it.
  std::map<std::pair<std::string, std::string>, const tinyxml2::XMLElement*> elements_;
};

/// Throws Error with the line of the element: "line LINE: <NAME>: WHAT".
[[noreturn]] void failAt(const tinyxml2::XMLElement& element, const std::string& what);

/// The numbers in the text of an element. Throws Error.
std::vector<double> numbersOf(const tinyxml2::XMLElement& element);
std::vector<std::int64_t> integersOf(const tinyxml2::XMLElement& element);

/// A count or an offset in an attribute. Throws Error if it is no integer from 0 to 2^32 - 1.
std::size_t countOf(const tinyxml2::XMLElement& element, const char* attribute);
/// The same with a value for a missing attribute.
std::size_t countOf(const tinyxml2::XMLElement& element, const char* attribute, std::size_t otherwise);

/// The only child of a kind. Throws Error if there are none or several.
const tinyxml2::XMLElement& onlyChild(const tinyxml2::XMLElement& element, const char* kind);
/// The only child <input> with a meaning, for example VERTEX. Throws Error if there are none or several.
const tinyxml2::XMLElement& onlyInput(const tinyxml2::XMLElement& element, const std::string& semantic);

/// Calls `visit` for each child element.
template <typename Visit>
void forEachChild(const tinyxml2::XMLElement& element, const Visit& visit)
{
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    visit(*child);
}
}  // namespace gpu_planning_scene::core
