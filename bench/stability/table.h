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
  Rapid,
  Dop18,
  Dop24,
  BoxTree,
  ConvexPatches,
  Recode,
  Cinder,
  Cullide,
  FattenedCullide,
  WorkQueues,
  BreadthFirst,
  ExactChecker,
  ExactWithProofs,
  MethodCount
};

struct MethodName
{
  const char* name;  ///< title of the column
  bool ours;
};
const std::array<MethodName, MethodCount>& methodNames();

/// A cell of the table. If the contract allows both answers, neither is wrong. But then the project's own methods must
/// agree with each other and on all copies of a case. If they do not, the answer counts as inconsistent.
struct Cell
{
  std::size_t cases = 0;  ///< 0: the method does not apply
  std::size_t false_free = 0;
  std::size_t false_collision = 0;
  std::size_t inconsistent = 0;
  std::size_t outside = 0;  ///< of the wrong answers: in cases for which the authors of the method claim nothing
  std::size_t wrong() const { return false_free + false_collision + inconsistent; }
};

struct Row
{
  std::string family;
  std::size_t colliding = 0;  ///< cases, by the oracle
  std::size_t free = 0;
  std::size_t either = 0;
  std::size_t undecided = 0;  ///< cases that the GPU left undecided
  std::size_t proven = 0;     ///< cases that balls decided for ExactWithProofs
  std::array<Cell, MethodCount> cells;
};

void count(Cell& cell, oracle::Verdict truth, bool collides);

struct Run
{
  std::uint64_t seed;
  std::size_t cases;
  std::string device;
};

/// Writes the conditions of the run, then the table.
void writeMarkdown(std::ostream& out, const Run& run, const std::vector<Row>& rows);
}  // namespace gpu_planning_scene::core::stability
