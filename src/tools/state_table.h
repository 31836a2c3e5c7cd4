#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// A CSV file of robot states: a header of variable names, then one state a row.
struct StateTable
{
  std::vector<std::string> names;
  std::vector<double> values;  ///< row-major
  std::size_t rows = 0;
};

/// Throws Error with file, line and column: a row of the wrong length, a cell that is not a finite number, no rows.
/// Cells may be quoted; spaces around them do not count.
StateTable readStateTable(const std::string& path);

/// A cell as CSV has it: quoted where it holds a comma, a quote or a line break.
std::string csvCell(const std::string& text);
}  // namespace gpu_planning_scene::core
