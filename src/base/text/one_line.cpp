#include "base/text/one_line.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kLongestWord = 300;
constexpr std::size_t kLongestText = 2000;

/// True for a byte that continues a UTF-8 character.
bool continues(char byte)
{
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// Shortens a text by its middle, because the reason of an error is often at its end.
std::string withoutMiddle(std::string_view text, std::size_t max_size)
{
  if (text.size() <= max_size)
    return std::string(text);
  std::size_t from = max_size / 2;
  while (from > 0 && continues(text[from]))
    --from;
  std::size_t to = text.size() - max_size / 2;
  while (to < text.size() && continues(text[to]))
    ++to;
  return std::string(text.substr(0, from)) + "[... " + std::to_string(to - from) + " bytes ...]" +
         std::string(text.substr(to));
}
}  // namespace

std::string onOneLine(std::string text)
{
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return text;
}

std::string shortLine(const std::string& text)
{
  const std::string line = onOneLine(text);
  std::string result;
  for (std::size_t from = 0; from < line.size();)
  {
    const std::size_t end = std::min(line.find(' ', from), line.size() - 1) + 1;
    result += withoutMiddle(std::string_view(line).substr(from, end - from), kLongestWord);
    from = end;
  }
  return withoutMiddle(result, kLongestText);
}
}  // namespace gpu_planning_scene::core
