#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace gpu_planning_scene::core
{
/// Cached answer: whether two bodies may come near each other.
enum class Near : std::uint8_t
{
  Unknown,
  Never,
  Perhaps
};

/// Cached answers for pairs of bodies, one body for each row and column.
class ReachabilityCache
{
 public:
  /// Keeps the answers for the rows and columns that exist before and after the call.
  void resize(std::size_t rows, std::size_t columns)
  {
    if (columns != columns_)
    {
      std::vector<Near> wider(rows * columns, Near::Unknown);
      for (std::size_t row = 0; row < std::min(rows, rows_); ++row)
        std::copy_n(cells_.begin() + offset(row, columns_), std::min(columns, columns_),
                    wider.begin() + offset(row, columns));
      cells_ = std::move(wider);
    }
    cells_.resize(rows * columns, Near::Unknown);
    rows_ = rows;
    columns_ = columns;
  }

  void clear() { std::fill(cells_.begin(), cells_.end(), Near::Unknown); }
  void forgetRow(std::size_t row) { std::fill_n(cells_.begin() + offset(row, columns_), columns_, Near::Unknown); }
  void forgetColumn(std::size_t column)
  {
    for (std::size_t row = 0; row < rows_; ++row)
      cells_[row * columns_ + column] = Near::Unknown;
  }

  /// Whether the two bodies may come near each other. Calls ask() only if the answer is not cached.
  template <class Ask>
  bool mayBeNear(std::size_t row, std::size_t column, const Ask& ask)
  {
    Near& cell = cells_[row * columns_ + column];
    if (cell == Near::Unknown)
      cell = ask() ? Near::Perhaps : Near::Never;
    return cell == Near::Perhaps;
  }

 private:
  static std::ptrdiff_t offset(std::size_t row, std::size_t columns)
  {
    return static_cast<std::ptrdiff_t>(row * columns);
  }

  std::vector<Near> cells_;
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
};
}  // namespace gpu_planning_scene::core
