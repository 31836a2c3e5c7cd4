#include "model/meshes/ply_header.h"

#include <algorithm>
#include <utility>

#include "base/text/parse_number.h"
#include "gpu_planning_scene/error.h"
#include "model/meshes/words.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::pair<std::string_view, PlyType> kPlyTypes[] = {
    {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::Uint8},
    {"uint8", PlyType::Uint8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
    {"ushort", PlyType::Uint16},  {"uint16", PlyType::Uint16},   {"int", PlyType::Int32},
    {"int32", PlyType::Int32},    {"uint", PlyType::Uint32},     {"uint32", PlyType::Uint32},
    {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
    {"float64", PlyType::Float64}};

constexpr std::pair<std::string_view, PlyFormat> kPlyFormats[] = {{"ascii", PlyFormat::Ascii},
                                                                  {"binary_little_endian", PlyFormat::LittleEndian},
                                                                  {"binary_big_endian", PlyFormat::BigEndian}};

template <typename Item>
bool hasName(const std::vector<Item>& items, std::string_view name)
{
  return std::any_of(
      items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
}

class HeaderReader
{
 public:
  explicit HeaderReader(std::string_view content) : content_(content) {}

  PlyHeader read()
  {
    // All lines end as the first one does. Behind the last one, any byte can be part of the first value.
    const std::size_t end = content_.substr(0, 5).find_first_of("\r\n");
    if (end == content_.npos)
      failInLine(1, "a PLY file begins with a line 'ply'");
    line_end_ = content_.substr(end, 2) == "\r\n" ? "\r\n" : content_.substr(end, 1);
    if (nextLine() != "ply")
      failInLine(1, "a PLY file begins with a line 'ply'");
    readFormat(nextLine());
    for (std::string_view line = nextLine(); !readStatement(line); line = nextLine())
    {
    }
    header_.bytes = at_;
    header_.lines = line_;
    return std::move(header_);
  }

 private:
  /// Without its end.
  std::string_view nextLine()
  {
    const std::size_t end = content_.find(line_end_, at_);
    ++line_;
    if (end == content_.npos)
      failInLine(line_, "the header ends before 'end_header'");
    const std::string_view line = content_.substr(at_, end - at_);
    at_ = end + line_end_.size();
    if (line.find_first_of("\r\n") != line.npos)
      failInLine(line_, "the lines of the header end in different ways; the file was damaged in a transfer as text");
    return line;
  }

  void readFormat(std::string_view line)
  {
    while (isComment(line))
      line = nextLine();
    Words words(line);
    const bool is_format = words.next() == "format";
    const std::string_view name = words.next();
    const auto format =
        std::find_if(std::begin(kPlyFormats), std::end(kPlyFormats), [&](const auto& f) { return f.first == name; });
    if (!is_format || format == std::end(kPlyFormats) || words.next() != "1.0" || !words.next().empty())
      failInLine(line_,
                 "expected 'format', one of ascii, binary_little_endian and binary_big_endian, and '1.0', found " +
                     inQuotes(line));
    header_.format = format->second;
  }

  static bool isComment(std::string_view line)
  {
    const std::string_view keyword = Words(line).next();
    return keyword == "comment" || keyword == "obj_info";
  }

  /// True at the end of the header.
  bool readStatement(std::string_view line)
  {
    if (isComment(line))
      return false;
    Words words(line);
    const std::string_view keyword = words.next();
    if (keyword == "element")
      readElement(words);
    else if (keyword == "property")
      readProperty(words);
    else if (keyword != "end_header")
      failInLine(line_, inQuotes(keyword) + " is no statement of a PLY header");
    if (!words.next().empty())
      failInLine(line_, inQuotes(line) + " has too many words");
    return keyword == "end_header";
  }

  void readElement(Words& words)
  {
    PlyElement element;
    element.name = words.next();
    const std::string_view count = words.next();
    const std::optional<long long> number = parseInteger(count);
    if (!number || *number < 0)
      failInLine(line_, "the number of elements " + inQuotes(element.name) + " is " + inQuotes(count));
    if (hasName(header_.elements, element.name))
      failInLine(line_, "the element " + inQuotes(element.name) + " is there twice");
    element.count = static_cast<std::uint64_t>(*number);
    header_.elements.push_back(std::move(element));
  }

  void readProperty(Words& words)
  {
    if (header_.elements.empty())
      failInLine(line_, "a property stands before the first element");
    PlyProperty property;
    std::string_view type = words.next();
    if (type == "list")
    {
      property.length_type = typeOf(words.next());
      if (*property.length_type == PlyType::Float32 || *property.length_type == PlyType::Float64)
        failInLine(line_, "the number of values in a list must have an integer type");
      type = words.next();
    }
    property.type = typeOf(type);
    property.name = words.next();
    std::vector<PlyProperty>& properties = header_.elements.back().properties;
    if (property.name.empty() || hasName(properties, property.name))
      failInLine(line_, "the property " + inQuotes(property.name) + " has no name, or is there twice");
    properties.push_back(std::move(property));
  }

  PlyType typeOf(std::string_view name) const
  {
    const auto type =
        std::find_if(std::begin(kPlyTypes), std::end(kPlyTypes), [&](const auto& t) { return t.first == name; });
    if (type == std::end(kPlyTypes))
      failInLine(line_, inQuotes(name) +
                            " is no type of PLY; the types are char, uchar, short, ushort, int, uint, float and "
                            "double");
    return type->second;
  }

  std::string_view content_;
  std::string_view line_end_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  PlyHeader header_{};
};
}  // namespace

PlyHeader readPlyHeader(std::string_view content)
{
  return HeaderReader(content).read();
}
}  // namespace gpu_planning_scene::core
