#include "scene/parse_number.h"

#include <charconv>

namespace gpu_planning_scene::core
{
namespace
{
template <typename Number>
std::optional<Number> parse(std::string_view text)
{
  if (text.size() > 1 && text[0] == '+' && text[1] != '-')
    text.remove_prefix(1);  // std::from_chars takes no plus sign
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size())
    return std::nullopt;
  return value;
}
}  // namespace

std::optional<double> parseNumber(std::string_view text)
{
  return parse<double>(text);
}

std::optional<long long> parseInteger(std::string_view text)
{
  return parse<long long>(text);
}
}  // namespace gpu_planning_scene::core
