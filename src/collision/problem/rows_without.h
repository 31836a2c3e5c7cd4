#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/parallel_for.h"

namespace gpu_planning_scene::core
{
/// The rows below `count` for which `holds(row)` is false, in ascending order. Many rows are split over all cores.
template <class Holds>
std::vector<std::size_t> rowsWithout(std::size_t count, const Holds& holds)
{
  constexpr std::size_t kRowsPerChunk = 16'384;  // testing these takes longer than starting a thread
  const auto collect = [&holds](std::size_t begin, std::size_t end, std::vector<std::size_t>& rows)
  {
    for (std::size_t row = begin; row < end; ++row)
      if (!holds(row))
        rows.push_back(row);
  };
  std::vector<std::size_t> rows;
  if (count <= kRowsPerChunk)
  {
    collect(0, count, rows);  // without the memory for several parts: this may be a single state
    return rows;
  }
  std::vector<std::vector<std::size_t>> found((count + kRowsPerChunk - 1) / kRowsPerChunk);
  parallelFor(count, kRowsPerChunk,
              [&](std::size_t begin, std::size_t end) { collect(begin, end, found[begin / kRowsPerChunk]); });
  for (const std::vector<std::size_t>& part : found)
    rows.insert(rows.end(), part.begin(), part.end());
  return rows;
}
}  // namespace gpu_planning_scene::core
