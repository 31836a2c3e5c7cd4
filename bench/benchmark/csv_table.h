#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

namespace gpu_planning_scene::core::benchmark
{
/// Makes the folder of the tables, unless it exists. Throws Error, which names the option --out.
void makeTableFolder(const std::string& folder);

/// A cell of a table. A number that is not finite gives an empty cell.
struct Cell
{
  Cell(const std::string& word);
  Cell(const char* word);
  Cell(double number);
  Cell(std::size_t number);
  std::string text;
};

/// A CSV file whose first line has the column titles. Each added row is written to disk immediately.
class CsvTable
{
 public:
  /// Throws Error if the file cannot be written.
  CsvTable(const std::string& folder, const std::string& name, const std::vector<std::string>& columns);
  /// `cells`: one per column. Throws Error if the file cannot be written.
  void add(const std::vector<Cell>& cells);

 private:
  std::string path_;
  std::size_t columns_;
  std::ofstream file_;
};
}  // namespace gpu_planning_scene::core::benchmark
