#include "base/text/utf8.h"

#include <cstddef>
#include <utility>

namespace gpu_planning_scene::core
{
namespace
{
/// The number of bytes of the character that begins at `at`; 0 if it is not well-formed (RFC 3629).
std::size_t characterLength(const std::string& text, std::size_t at)
{
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at);
  if (first < 0x80)
    return 1;
  const std::size_t length = first >= 0xC2 && first <= 0xDF   ? 2
                             : first >= 0xE0 && first <= 0xEF ? 3
                             : first >= 0xF0 && first <= 0xF4 ? 4
                                                              : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(at + i) & 0xC0) != 0x80)
      return 0;
  const bool overlong = (first == 0xE0 && byte(at + 1) < 0xA0) || (first == 0xF0 && byte(at + 1) < 0x90);
  const bool surrogate = first == 0xED && byte(at + 1) > 0x9F;
  const bool too_large = first == 0xF4 && byte(at + 1) > 0x8F;
  return overlong || surrogate || too_large ? 0 : length;
}

bool isUtf8(const std::string& text)
{
  for (std::size_t at = 0; at < text.size();)
  {
    const std::size_t length = characterLength(text, at);
    if (length == 0)
      return false;
    at += length;
  }
  return true;
}

/// Writes UTF-8 as the encoding of the XML declaration.
void declareUtf8(std::string& text)
{
  const std::size_t end = text.compare(0, 5, "<?xml") == 0 ? text.find("?>") : std::string::npos;
  const std::size_t key = text.find("encoding");
  const std::size_t begin = end == std::string::npos || key > end ? end : text.find_first_of("\"'", key);
  if (begin >= end)
    return;
  if (const std::size_t close = text.find(text[begin], begin + 1); close < end)
    text.replace(begin + 1, close - begin - 1, "UTF-8");
}
}  // namespace

std::string inUtf8(std::string text)
{
  if (isUtf8(text))
    return text;
  std::string result;
  result.reserve(text.size() + text.size() / 8);
  for (const char letter : text)
  {
    const auto code = static_cast<unsigned char>(letter);  // ISO-8859-1 has the first 256 code points of Unicode
    if (code < 0x80)
      result += letter;
    else
    {
      result += static_cast<char>(0xC0 | (code >> 6));
      result += static_cast<char>(0x80 | (code & 0x3F));
    }
  }
  return result;
}

std::string xmlInUtf8(std::string text)
{
  if (isUtf8(text))
    return text;
  std::string result = inUtf8(std::move(text));
  declareUtf8(result);
  return result;
}
}  // namespace gpu_planning_scene::core
