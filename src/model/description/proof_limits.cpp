#include "model/description/proof_limits.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "model/robot_text.h"
#include "model/text/parse_number.h"

namespace gpu_planning_scene::core
{
namespace
{
using Range = std::pair<double, double>;

/// The range of a text "LOWER to UPPER)" that begins at `at`; no value: another text.
std::optional<Range> rangeAt(const std::string& text, std::size_t at)
{
  const std::size_t end = text.find(')', at);
  const std::size_t between = text.find(" to ", at);
  if (end == std::string::npos || between == std::string::npos || between > end)
    return std::nullopt;
  const std::optional<double> lower = parseNumber(text.substr(at, between - at));
  const std::optional<double> upper = parseNumber(text.substr(between + 4, end - between - 4));
  return lower && upper ? std::make_optional(Range(*lower, *upper)) : std::nullopt;
}

/// The ranges that the text gives for a variable, in the form of describeVariable.
std::vector<Range> rangesOf(const std::string& variable, const std::string& text)
{
  std::vector<Range> ranges;
  for (std::size_t at = text.find(variable + " ("); at != std::string::npos; at = text.find(variable + " (", at + 1))
    if (at == 0 || std::isspace(static_cast<unsigned char>(text[at - 1])) != 0)
      if (const auto range = rangeAt(text, at + variable.size() + 2))
        ranges.push_back(*range);
  return ranges;
}
}  // namespace

std::vector<std::string> limitsBeyondProofs(const std::vector<Variable>& variables, const std::vector<int>& widened,
                                            const std::string& srdf)
{
  std::vector<std::string> beyond;
  for (std::size_t i = 0; i < variables.size(); ++i)
  {
    const Variable& variable = variables[i];
    if (!variable.bounded)
      continue;
    const std::string limits = describeVariable(variable);
    const Range own = rangesOf(variable.name, limits).at(0);  // rounded as in the comment
    const std::vector<Range> proven = rangesOf(variable.name, srdf);
    const bool is_wider =
        proven.empty()
            ? std::count(widened.begin(), widened.end(), static_cast<int>(i)) != 0
            : std::any_of(proven.begin(), proven.end(),
                          [&own](const Range& range) { return own.first < range.first || own.second > range.second; });
    if (is_wider)
      beyond.push_back(limits);
  }
  return beyond;
}
}  // namespace gpu_planning_scene::core
