#include "tools/state_table.h"

#include <cmath>

#include "base/text/parse_number.h"
#include "gpu_planning_scene/error.h"
#include "model/files/open_file.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string trimmed(const std::string& text)
{
  const char* blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// Splits a row of CSV into cells. A cell may be in quotes, with each quote inside doubled.
std::vector<std::string> splitRow(const std::string& line, const std::string& where)
{
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[++i];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += line[i];
  if (quoted)
    throw Error(where + ": a quotation mark is not closed");
  for (std::string& cell : cells)
    cell = trimmed(cell);
  return cells;
}

double readCell(const std::string& cell, const std::string& where)
{
  const auto value = parseNumber(cell);
  if (!value || !std::isfinite(*value))
    throw Error(where + ": '" + cell + "' is not a finite number");
  return *value;
}
}  // namespace

StateTable readStateTable(const std::string& path)
{
  std::ifstream file = openFile(path);
  std::string line;
  std::getline(file, line);
  if (line.compare(0, 3, "\xEF\xBB\xBF") == 0)
    line.erase(0, 3);  // byte-order mark, as written by spreadsheets
  StateTable table;
  table.names = splitRow(line, path + ":1");
  for (std::size_t i = 0; i < table.names.size(); ++i)
    if (table.names[i].empty() || parseNumber(table.names[i]))
      throw Error(path + ":1: column " + std::to_string(i + 1) +
                  ": the first line must name the variables, one per column; found '" + table.names[i] + "'");

  std::size_t first_blank = 0;
  for (std::size_t number = 2; std::getline(file, line); ++number)
  {
    const std::string where = path + ":" + std::to_string(number);
    if (trimmed(line).empty())
    {
      first_blank = first_blank ? first_blank : number;
      continue;
    }
    if (first_blank)
      throw Error(path + ":" + std::to_string(first_blank) + ": an empty line between states");
    const auto cells = splitRow(line, where);
    if (cells.size() != table.names.size())
      throw Error(where + ": " + std::to_string(cells.size()) + " values for " + std::to_string(table.names.size()) +
                  " variables");
    for (std::size_t i = 0; i < cells.size(); ++i)
      table.values.push_back(
          readCell(cells[i], where + ": column " + std::to_string(i + 1) + " (" + table.names[i] + ")"));
    ++table.rows;
  }
  if (file.bad())
    throw Error(path + ": reading the file failed");
  if (table.rows == 0)
    throw Error(path + ": no states, only a header");
  return table;
}

std::string csvCell(const std::string& text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos)
    return text;
  std::string cell = "\"";
  for (const char c : text)
    cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}
}  // namespace gpu_planning_scene::core
