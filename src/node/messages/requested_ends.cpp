#include "node/messages/requested_ends.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "gpu_planning_scene/error.h"
#include "node/messages/requested_states.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Rows of values for `columns`. A named state is one row, which all motions use.
struct EndRows
{
  std::vector<int> columns;
  std::vector<double> values;
  bool is_named = false;

  std::size_t count() const { return values.size() / columns.size(); }
  /// The index of a column in a row; -1 if the rows do not have it.
  std::ptrdiff_t indexOf(int column) const
  {
    const auto found = std::find(columns.begin(), columns.end(), column);
    return found == columns.end() ? -1 : found - columns.begin();
  }
  const double* row(std::size_t motion) const { return values.data() + (is_named ? 0 : motion * columns.size()); }
};

/// `name`: the field for a state that the SRDF names. `rows`: the field that it replaces.
EndRows rowsOf(const RobotModel& robot, const CheckMotions::Request& request, const RequestField<std::string>& name,
               const RequestField<std::vector<double>>& rows, const std::function<void(std::size_t)>& require_count)
{
  EndRows result;
  if (name.values.empty())
  {
    result.columns = requestedColumns(robot, {"joint_names", request.joint_names}, rows, require_count);
    result.values = rows.values;
    return result;
  }
  const bool both_named = !request.named_start.empty() && !request.named_end.empty();
  const char* conflict = !rows.values.empty()                         ? rows.name
                         : both_named && !request.joint_names.empty() ? "joint_names"
                                                                      : nullptr;
  const NamedRow state = requestedNamedState(robot, name, conflict);
  result.columns = requestedColumns(robot, {name.name, state.names}, {name.name, state.values}, require_count);
  result.values = state.values;
  result.is_named = true;
  return result;
}
}  // namespace

RequestedEnds requestedEnds(const RobotModel& robot, const CheckMotions::Request& request, const PartialState& current,
                            const std::function<void(std::size_t)>& require_count)
{
  if (request.named_start.empty() && request.named_end.empty() && request.starts.size() != request.ends.size())
    throw Error(std::to_string(request.starts.size()) + " values in starts and " + std::to_string(request.ends.size()) +
                " in ends; give one row of each per motion");
  const EndRows starts =
      rowsOf(robot, request, {"named_start", request.named_start}, {"starts", request.starts}, require_count);
  const EndRows ends = rowsOf(robot, request, {"named_end", request.named_end}, {"ends", request.ends}, require_count);

  RequestedEnds result{starts.columns, {}, {}, starts.is_named ? ends.count() : starts.count()};
  for (const int column : ends.columns)
    if (starts.indexOf(column) < 0)
      result.columns.push_back(column);
  requireWholeRotations(robot, result.columns);
  fullStates(robot, starts.columns, nullptr, 0, current);  // throws Error if a value of the starts is not known
  for (std::size_t motion = 0; motion < result.count; ++motion)
    for (const int column : result.columns)
    {
      const std::ptrdiff_t start = starts.indexOf(column);
      const std::ptrdiff_t end = ends.indexOf(column);
      result.starts.push_back(start >= 0 ? starts.row(motion)[start]
                                         : current.values[static_cast<std::size_t>(column)]);
      result.ends.push_back(end >= 0 ? ends.row(motion)[end] : result.starts.back());
    }
  return result;
}
}  // namespace gpu_planning_scene::core
