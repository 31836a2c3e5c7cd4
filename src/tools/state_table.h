#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// A CSV file of robot states: a header of variable names, then one state per row.
struct StateTable
{
  std::vector<std::string> names;
  std::vector<double> values;  ///< row-major
  std::size_t rows = 0;
};

/// Reads a CSV file. Cells may be quoted; spaces around them are ignored. Throws Error with file, line and column for a
/// row of the wrong length, a cell that is not a finite number, and a file without rows.
StateTable readStateTable(const std::string& path);

/// A text as a CSV cell: in quotes if it contains a comma, a quote or a line break.
std::string csvCell(const std::string& text);
}  // namespace gpu_planning_scene::core
