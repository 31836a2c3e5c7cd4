#include "model/meshes/collada_document.h"

#include <cstring>

#include "gpu_planning_scene/error.h"
#include "model/meshes/words.h"

namespace gpu_planning_scene::core
{
namespace
{
using tinyxml2::XMLElement;

/// Calls `use` for each word of the element's text, with its line. Comments may stand in the text.
template <typename Use>
void forEachWord(const XMLElement& element, const Use& use)
{
  for (const auto* node = element.FirstChild(); node != nullptr; node = node->NextSibling())
  {
    if (const auto* child = node->ToElement())
      failAt(*child, "it stands among the numbers of <" + std::string(element.Name()) + ">");
    const auto* text = node->ToText();
    if (text == nullptr)
      continue;
    Words words(text->Value(), static_cast<std::size_t>(text->GetLineNum()));
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      use(word, words.line());
  }
}

template <typename Visit>
const XMLElement& only(const XMLElement& element, const std::string& what, const Visit& is_wanted)
{
  const XMLElement* found = nullptr;
  forEachChild(element,
               [&](const XMLElement& child)
               {
                 if (!is_wanted(child))
                   return;
                 if (found != nullptr)
                   failAt(child, "it stands there twice");
                 found = &child;
               });
  if (found == nullptr)
    failAt(element, "it has no " + what);
  return *found;
}
}  // namespace

ColladaDocument::ColladaDocument(std::string_view text)
{
  if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    failInLine(static_cast<std::size_t>(std::max(1, document_.ErrorLineNum())),
               std::string("the XML is malformed (") + document_.ErrorName() + ")");
  if (document_.RootElement() == nullptr)
    failInLine(1, "there is no XML element");
  if (std::strcmp(root().Name(), "COLLADA") != 0)
    failAt(root(), "the root element of a COLLADA file is <COLLADA>");
  collect(root());
}

void ColladaDocument::collect(const XMLElement& element)
{
  if (const char* id = element.Attribute("id"))
  {
    const auto [place, is_new] = elements_.try_emplace({element.Name(), id}, &element);
    if (!is_new)
      place->second = nullptr;
  }
  forEachChild(element, [this](const XMLElement& child) { collect(child); });
}

const XMLElement& ColladaDocument::target(const XMLElement& element, const char* attribute,
                                          const std::string& kind) const
{
  const char* url = element.Attribute(attribute);
  if (url == nullptr)
    failAt(element, "it has no attribute '" + std::string(attribute) + "'");
  if (url[0] != '#')
    failAt(element, inQuotes(url) + " is not in this file; only '#ID' can be read, so export one file");
  const auto found = elements_.find({kind, url + 1});
  if (found == elements_.end())
    failAt(element, "there is no <" + kind + "> with the id " + inQuotes(url + 1));
  if (found->second == nullptr)
    failAt(element, "there are two <" + kind + "> with the id " + inQuotes(url + 1));
  return *found->second;
}

void failAt(const XMLElement& element, const std::string& what)
{
  failInLine(static_cast<std::size_t>(element.GetLineNum()), "<" + std::string(element.Name()) + ">: " + what);
}

std::vector<double> numbersOf(const XMLElement& element)
{
  std::vector<double> numbers;
  forEachWord(element, [&](std::string_view word, std::size_t line) { numbers.push_back(numberFrom(word, line)); });
  return numbers;
}

std::vector<std::int64_t> integersOf(const XMLElement& element)
{
  std::vector<std::int64_t> integers;
  forEachWord(element, [&](std::string_view word, std::size_t line) { integers.push_back(integerFrom(word, line)); });
  return integers;
}

std::size_t countOf(const XMLElement& element, const char* attribute)
{
  const char* text = element.Attribute(attribute);
  if (text == nullptr)
    failAt(element, "it has no attribute '" + std::string(attribute) + "'");
  const std::int64_t count = integerFrom(text, static_cast<std::size_t>(element.GetLineNum()));
  if (count < 0 || count > 0xffffffff)
    failAt(element, std::string(attribute) + " is " + inQuotes(text));
  return static_cast<std::size_t>(count);
}

std::size_t countOf(const XMLElement& element, const char* attribute, std::size_t otherwise)
{
  return element.Attribute(attribute) == nullptr ? otherwise : countOf(element, attribute);
}

const XMLElement& onlyChild(const XMLElement& element, const char* kind)
{
  return only(
      element, "<" + std::string(kind) + ">",
      [kind](const XMLElement& child) { return std::strcmp(child.Name(), kind) == 0; });
}

const XMLElement& onlyInput(const XMLElement& element, const std::string& semantic)
{
  return only(
      element, "<input> with the semantic " + semantic,
      [&](const XMLElement& child)
      { return std::strcmp(child.Name(), "input") == 0 && child.Attribute("semantic", semantic.c_str()) != nullptr; });
}
}  // namespace gpu_planning_scene::core
