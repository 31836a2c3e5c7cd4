#include "model/meshes/words.h"

#include <cmath>
#include <optional>

#include "base/text/one_line.h"
#include "base/text/parse_number.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
bool isSpace(char c)
{
  return c == ' ' || (c >= '\t' && c <= '\r');
}
}  // namespace

std::string_view Words::next()
{
  for (; at_ < text_.size() && isSpace(text_[at_]); ++at_)
    line_ += text_[at_] == '\n' ? 1 : 0;
  const std::size_t begin = at_;
  while (at_ < text_.size() && !isSpace(text_[at_]))
    ++at_;
  return text_.substr(begin, at_ - begin);
}

void Words::skipLine()
{
  while (at_ < text_.size() && text_[at_] != '\n')
    ++at_;
}

std::string_view withoutByteOrderMark(std::string_view text)
{
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(0, kMark.size()) == kMark ? text.substr(kMark.size()) : text;
}

std::string inQuotes(std::string_view word)
{
  constexpr std::size_t kMaxLength = 40;
  const bool is_long = word.size() > kMaxLength;
  return "'" + onOneLine(std::string(word.substr(0, kMaxLength))) + (is_long ? "...'" : "'");
}

double numberFrom(std::string_view word, std::size_t line)
{
  const std::optional<double> value = parseNumber(word);
  if (!value)
    failInLine(line, inQuotes(word) + " is not a number, or one that a double cannot hold");
  if (!std::isfinite(*value))
    failInLine(line, inQuotes(word) + " is not finite");
  return *value;
}

std::int64_t integerFrom(std::string_view word, std::size_t line)
{
  const std::optional<long long> value = parseInteger(word);
  if (!value)
    failInLine(line, inQuotes(word) + " is not an integer");
  return *value;
}

void failInLine(std::size_t line, const std::string& what)
{
  throw Error("line " + std::to_string(line) + ": " + what);
}
}  // namespace gpu_planning_scene::core
