#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace gpu_planning_scene
{
/// A part of a batch's states, and the part of the rows that is enough for it: from the first to the last that one of
/// the states refers to.
struct UsedRows
{
  /// `rows`: one per state. Of states [begin, begin + count), at least one.
  UsedRows(const std::vector<std::uint32_t>& all, std::size_t begin, std::size_t count)
    : rows(all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(begin + count))
  {
    const auto [least, most] = std::minmax_element(rows.begin(), rows.end());
    first = *least;
    end = *most + std::size_t{1};
    for (std::uint32_t& row : rows)
      row -= static_cast<std::uint32_t>(first);
  }

  /// The values of those rows, each of `width`.
  template <class Value>
  std::vector<Value> cut(const std::vector<Value>& values, std::size_t width) const
  {
    return {values.begin() + static_cast<std::ptrdiff_t>(first * width),
            values.begin() + static_cast<std::ptrdiff_t>(end * width)};
  }

  std::vector<std::uint32_t> rows;  ///< of the states of the part, counted from `first`
  std::size_t first = 0;
  std::size_t end = 0;  ///< one past the last
};
}  // namespace gpu_planning_scene
