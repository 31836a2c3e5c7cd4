#include "stability/table.h"

#include <ostream>

namespace gpu_planning_scene::core::stability
{
const std::array<MethodName, MethodCount>& methodNames()
{
  static const std::array<MethodName, MethodCount> names = {{
      {"FCL, default (libccd)", false},
      {"FCL, its own GJK", false},
      {"float32, no filter", false},
      {"Bullet, hulls", false},
      {"oriented boxes (RAPID)", false},
      {"18-DOPs", false},
      {"24-DOPs", false},
      {"box trees", false},
      {"convex patches", false},
      {"RECODE", false},
      {"CInDeR", false},
      {"CULLIDE", false},
      {"CULLIDE, fattened", false},
      {"ours, work queues", true},
      {"ours, breadth-first", true},
      {"ours, exact checker", true},
      {"ours, with proofs", true},
  }};
  return names;
}

void count(Cell& cell, oracle::Verdict truth, bool collides)
{
  ++cell.cases;
  if (truth == oracle::Verdict::Collides && !collides)
    ++cell.false_free;
  if (truth == oracle::Verdict::Free && collides)
    ++cell.false_collision;
}

void writeMarkdown(std::ostream& out, const Run& run, const std::vector<Row>& rows)
{
  std::size_t cases = 0;
  for (const Row& row : rows)
    cases += row.colliding + row.free + row.either;
  out << "# The stability table\n\n"
      << "For people who want the numbers behind [stability.md](stability.md), which describes the methods and the "
         "cases.\n\n"
      << cases << " cases, " << run.cases << " of most families, seed " << run.seed << ", on " << run.device << ".\n\n"
      << "A cell is *wrong answers: false \"free\" + false \"collision\"*; 0: no wrong answer; -: the method does not "
         "support\nthese cases. "
         "[n]: of the wrong answers, n are in cases outside the domain of the method. Of n: the method checked only n "
         "cases; a cell with 0 does not show this (see stability.md).\n\n"
      << "| cases | colliding / free / either |";
  for (const MethodName& method : methodNames())
    out << ' ' << method.name << " |";
  out << "\n| --- | --- |";
  for (std::size_t i = 0; i < MethodCount; ++i)
    out << " --- |";
  out << '\n';
  for (const Row& row : rows)
  {
    out << "| " << row.family << " | " << row.colliding << " / " << row.free << " / " << row.either << " |";
    for (const Cell& cell : row.cells)
    {
      if (cell.cases == 0)
        out << " - |";
      else if (cell.wrong() == 0)
        out << " 0 |";
      else
      {
        out << " **" << cell.wrong() << "**: " << cell.false_free << " + " << cell.false_collision;
        if (cell.inconsistent > 0)
          out << ", " << cell.inconsistent << " inconsistent";
        if (cell.outside > 0)
          out << " [" << cell.outside << ']';
        if (cell.cases < row.colliding + row.free + row.either)
          out << " of " << cell.cases;
        out << " |";
      }
    }
    out << '\n';
  }
}
}  // namespace gpu_planning_scene::core::stability
