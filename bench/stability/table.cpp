#include "stability/table.h"

#include <ostream>

namespace gpu_planning_scene::core::stability
{
const std::array<MethodName, MethodCount>& methodNames()
{
  static const std::array<MethodName, MethodCount> names = {{
      {"FCL, default (libccd)", "fcl", false},
      {"FCL, its own GJK", "fcl_own", false},
      {"float32, no filter", "float32", false},
      {"Bullet, hulls", "bullet", false},
      {"oriented boxes (RAPID)", "rapid", false},
      {"18-DOPs", "dop18", false},
      {"24-DOPs", "dop24", false},
      {"box trees", "box_tree", false},
      {"convex patches", "convex_patches", false},
      {"RECODE", "recode", false},
      {"CInDeR", "cinder", false},
      {"CULLIDE", "cullide", false},
      {"CULLIDE, fattened", "cullide_fattened", false},
      {"ours, work queues", "work_queue", true},
      {"ours, breadth-first", "breadth_first", true},
      {"ours, exact checker", "exact", true},
      {"ours, with proofs", "proofs", true},
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

void writeCsv(std::ostream& out, const std::vector<Row>& rows)
{
  out << "family,colliding,free,either,undecided,method,title,ours,cases,false_free,false_collision,inconsistent,"
         "outside\n";
  for (const Row& row : rows)
  {
    for (std::size_t i = 0; i < MethodCount; ++i)
    {
      const Cell& cell = row.cells[i];
      const MethodName& method = methodNames()[i];
      out << '"' << row.family << "\"," << row.colliding << ',' << row.free << ',' << row.either << ',' << row.undecided
          << ',' << method.short_name << ",\"" << method.name << "\"," << method.ours << ',' << cell.cases << ','
          << cell.false_free << ',' << cell.false_collision << ',' << cell.inconsistent << ',' << cell.outside << '\n';
    }
  }
}
}  // namespace gpu_planning_scene::core::stability
