#pragma once

#include <array>
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "oracle/oracle.h"

namespace gpu_planning_scene::core::stability
{
enum Method : std::size_t
{
  FclDefault,
  FclOwn,
  PlainFloat,
  BulletHulls,
  WorkQueues,
  BreadthFirst,
  ExactChecker,
  MethodCount
};

struct MethodName
{
  const char* name;  ///< a column's title
  const char* short_name;
  bool ours;
};
const std::array<MethodName, MethodCount>& methodNames();

/// A cell of the table. Where the contract allows both answers, neither is wrong; but the project's own methods agree
/// with each other there, and on all copies of a case: where they do not, the answer counts as inconsistent.
struct Cell
{
  std::size_t cases = 0;  ///< 0: the method does not apply
  std::size_t false_free = 0;
  std::size_t false_collision = 0;
  std::size_t inconsistent = 0;
  std::size_t wrong() const { return false_free + false_collision + inconsistent; }
};

struct Row
{
  std::string family;
  std::size_t colliding = 0;  ///< by the oracle
  std::size_t free = 0;
  std::size_t either = 0;
  std::size_t undecided = 0;  ///< that the GPU left to the CPU, of all cases
  std::array<Cell, MethodCount> cells;
};

void count(Cell& cell, oracle::Verdict truth, bool collides);

struct Run
{
  std::uint64_t seed;
  std::size_t cases;
  std::string device;
};

/// What the numbers are of, then a table.
void writeMarkdown(std::ostream& out, const Run& run, const std::vector<Row>& rows);
/// One line for each cell.
void writeCsv(std::ostream& out, const std::vector<Row>& rows);
}  // namespace gpu_planning_scene::core::stability
