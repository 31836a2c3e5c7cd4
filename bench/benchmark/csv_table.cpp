#include "benchmark/csv_table.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core::benchmark
{
void makeTableFolder(const std::string& folder)
{
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw Error("--out: cannot make the folder " + folder + ": " + failed.message());
}

Cell::Cell(const std::string& word) : text(word)
{
  // Titles contain commas.
  if (text.find_first_of(",\"\n") != std::string::npos)
    text = '"' + text + '"';
}

Cell::Cell(const char* word) : Cell(std::string(word)) {}

Cell::Cell(double number)
{
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", number);
  if (std::isfinite(number))
    text = buffer;
}

Cell::Cell(std::size_t number) : text(std::to_string(number)) {}

CsvTable::CsvTable(const std::string& folder, const std::string& name, const std::vector<std::string>& columns)
  : path_(folder + "/" + name), columns_(columns.size()), file_(path_)
{
  add(std::vector<Cell>(columns.begin(), columns.end()));
}

void CsvTable::add(const std::vector<Cell>& cells)
{
  if (cells.size() != columns_)
    throw std::logic_error(path_ + ": a row of " + std::to_string(cells.size()) + " cells");
  for (std::size_t i = 0; i < cells.size(); ++i)
    file_ << (i == 0 ? "" : ",") << cells[i].text;
  if (!(file_ << std::endl))
    throw Error(path_ + ": cannot be written; give --out another folder");
}
}  // namespace gpu_planning_scene::core::benchmark
