#include "base/text/parse_number.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <string>

#include <locale.h>

namespace gpu_planning_scene::core
{
namespace
{
/// std::from_chars takes no plus sign.
std::string_view withoutPlus(std::string_view text)
{
  if (text.size() > 1 && text[0] == '+' && text[1] != '-')
    text.remove_prefix(1);
  return text;
}

/// strtod also takes leading blanks, a plus sign and hexadecimal numbers.
bool beginsLikeADecimalNumber(std::string_view text)
{
  if (text.substr(0, 1) == "-")
    text.remove_prefix(1);
  return !text.empty() && std::string_view("+ \t\n\v\f\r").find(text[0]) == std::string_view::npos &&
         text.substr(0, 2) != "0x" && text.substr(0, 2) != "0X";
}
}  // namespace

/// std::from_chars reads doubles only since GCC 11.
std::optional<double> parseNumber(std::string_view text)
{
  static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);  // a decimal point whatever the user's locale
  const std::string number(withoutPlus(text));
  if (!beginsLikeADecimalNumber(number))
    return std::nullopt;
  char* end = nullptr;
  errno = 0;
  const double value = strtod_l(number.c_str(), &end, c_locale);
  const bool out_of_range = errno == ERANGE && (value == 0.0 || std::isinf(value));
  if (out_of_range || end != number.c_str() + number.size())
    return std::nullopt;
  return value;
}

std::optional<long long> parseInteger(std::string_view text)
{
  text = withoutPlus(text);
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size())
    return std::nullopt;
  return value;
}
}  // namespace gpu_planning_scene::core
