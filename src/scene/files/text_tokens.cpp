#include "scene/files/text_tokens.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/text/one_line.h"
#include "base/text/parse_number.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
const char* const kBlanks = " \t\r\n\v\f";

std::string shown(std::string_view word)
{
  constexpr std::size_t kLongest = 40;
  return "'" + onOneLine(std::string(word.substr(0, kLongest))) + (word.size() > kLongest ? "...'" : "'");
}
}  // namespace

TextTokens::TextTokens(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

void TextTokens::fail(const std::string& what) const
{
  throw Error(file_ + ":" + std::to_string(line_) + ": " + what);
}

std::string_view TextTokens::peek()
{
  for (; at_ < text_.size() && std::string_view(kBlanks).find(text_[at_]) != std::string_view::npos; ++at_)
    line_ += text_[at_] == '\n' ? 1 : 0;
  const std::size_t end = std::min(text_.find_first_of(kBlanks, at_), text_.size());
  return std::string_view(text_).substr(at_, end - at_);
}

std::string TextTokens::word(const char* what)
{
  const std::string_view next = peek();
  if (next.empty())
    fail(std::string("the file ends where ") + what + " should be");
  at_ += next.size();
  return std::string(next);
}

std::string TextTokens::restOfLine()
{
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  const std::string line = text_.substr(at_, end - at_);
  at_ = std::min(end + 1, text_.size());
  line_ += end < text_.size() ? 1 : 0;
  const std::size_t first = line.find_first_not_of(kBlanks);
  return first == std::string::npos ? std::string() : line.substr(first, line.find_last_not_of(kBlanks) - first + 1);
}

bool TextTokens::nextLineHasSeveralWords()
{
  const std::string_view first = peek();
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  return text_.find_first_not_of(kBlanks, at_ + first.size()) < end;
}

double TextTokens::number(const char* what)
{
  const std::string text = word(what);
  const std::optional<double> value = parseNumber(text);
  if (!value || !std::isfinite(*value))
    fail(std::string("expected ") + what + ", a finite number, found " + shown(text));
  return *value;
}

std::size_t TextTokens::index(const char* what)
{
  const std::string text = word(what);
  const std::optional<long long> value = parseInteger(text);
  if (!value || *value < 0)
    fail(std::string("expected ") + what + ", a whole number, found " + shown(text));
  return static_cast<std::size_t>(*value);
}

/// Each counted item takes at least one character. So a wrong count does not allocate more memory than the file
/// justifies.
std::size_t TextTokens::count(const char* what)
{
  const std::size_t value = index(what);
  if (value > text_.size() - at_)
    fail(std::string(what) + " is " + std::to_string(value) + ", but the rest of the file is shorter");
  return value;
}

Eigen::Vector3d TextTokens::vector(const char* what)
{
  Eigen::Vector3d result;
  for (int i = 0; i < 3; ++i)
    result[i] = number(what);
  return result;
}

Eigen::Isometry3d TextTokens::pose()
{
  const Eigen::Vector3d position = vector("a position (x y z)");
  Eigen::Vector4d components;
  for (int i = 0; i < 4; ++i)
    components[i] = number("an orientation (x y z w)");
  const double norm = components.stableNorm();
  if (norm == 0.0)
    fail("the quaternion is zero; the identity is 0 0 0 1");
  return Eigen::Translation3d(position) * Eigen::Quaterniond(Eigen::Vector4d(components / norm)).normalized();
}
}  // namespace gpu_planning_scene::core
