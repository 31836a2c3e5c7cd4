#include "model/description/proof_limits.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "base/text/parse_number.h"
#include "model/robot_text.h"

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

/// The comments that generate_acm has written.
std::string commentsOf(const std::string& srdf)
{
  static const std::string begin = std::string("<!--") + kGeneratedComment;
  std::string comments;
  for (std::size_t at = srdf.find(begin); at != std::string::npos; at = srdf.find(begin, at + 1))
    comments += srdf.substr(at, srdf.find("-->", at) - at);
  return comments;
}

/// The ranges that a list gives for a variable, in the form of describeVariable.
std::vector<Range> rangesOf(const std::string& variable, const std::string& list)
{
  const std::string entry = withoutDoubleHyphens(variable) + " (";
  std::vector<Range> ranges;
  for (std::size_t at = list.find(entry); at != std::string::npos; at = list.find(entry, at + 1))
    if (at == 0 || (at >= 2 && (list.compare(at - 2, 2, ", ") == 0 || list.compare(at - 2, 2, ": ") == 0)))
      if (const auto range = rangeAt(list, at + entry.size()))
        ranges.push_back(*range);
  return ranges;
}

/// The variables of planar and floating joints: no proof for two links depends on them.
std::set<std::size_t> baseVariables(const std::vector<Joint>& joints)
{
  std::set<std::size_t> found;
  for (const Joint& joint : joints)
    for (int i = 0; i < variableCount(joint.type) && variableCount(joint.type) > 1; ++i)
      found.insert(static_cast<std::size_t>(joint.first_variable + i));
  return found;
}
}  // namespace

std::string withoutDoubleHyphens(std::string comment)
{
  for (std::size_t at = comment.find("--"); at != std::string::npos; at = comment.find("--"))
    comment.replace(at, 2, "- -");
  return comment;
}

std::vector<std::string> limitsBeyondProofs(const std::vector<Joint>& joints, const std::vector<Variable>& variables,
                                            const std::vector<int>& widened, const std::string& srdf)
{
  const std::string comments = commentsOf(srdf);
  const std::set<std::size_t> of_bases = baseVariables(joints);
  std::vector<std::string> beyond;
  for (std::size_t i = 0; i < variables.size(); ++i)
  {
    const Variable& variable = variables[i];
    if (of_bases.count(i) != 0)
      continue;
    const std::string limits = describeVariable(variable);
    const std::vector<Range> own = rangesOf(variable.name, withoutDoubleHyphens(limits));  // rounded as in the comment
    const std::vector<Range> proven = rangesOf(variable.name, comments);
    const auto is_beyond = [&own](const Range& range)
    { return own.empty() || own[0].first < range.first || own[0].second > range.second; };
    if (proven.empty() ? std::count(widened.begin(), widened.end(), static_cast<int>(i)) != 0
                       : std::any_of(proven.begin(), proven.end(), is_beyond))
      beyond.push_back(limits);
  }
  return beyond;
}
}  // namespace gpu_planning_scene::core
