#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace gpu_planning_scene::core
{
/// Disjoint sets with path halving (R. E. Tarjan, J. van Leeuwen: Worst-case analysis of set union algorithms. Journal
/// of the ACM 31(2), 1984).
class DisjointSets
{
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t find(std::uint32_t element)
  {
    while (parent_[element] != element)
      element = parent_[element] = parent_[parent_[element]];
    return element;
  }

  void unite(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

  /// The elements of each set, in ascending order; the sets in the order of their first elements.
  std::vector<std::vector<std::uint32_t>> sets()
  {
    std::vector<std::vector<std::uint32_t>> result;
    std::vector<std::size_t> number(parent_.size(), parent_.size());
    for (std::uint32_t element = 0; element < parent_.size(); ++element)
    {
      std::size_t& set = number[find(element)];
      if (set == parent_.size())
      {
        set = result.size();
        result.emplace_back();
      }
      result[set].push_back(element);
    }
    return result;
  }

 private:
  std::vector<std::uint32_t> parent_;
};
}  // namespace gpu_planning_scene::core
