#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace gpu_planning_scene::core
{
/// The order in which the checks of a state are made, learned as ExactChecker learns its order: checks that found most
/// collisions for their cost come first.
class LearnedOrder
{
 public:
  explicit LearnedOrder(std::size_t checks) : order_(checks), hits_(checks, 0.0), cost_(checks, kLeastCost)
  {
    std::iota(order_.begin(), order_.end(), 0U);
  }

  /// Calls check(number, seconds) in order until it returns true, and returns whether it did. The check adds its time
  /// to `seconds`.
  template <class Check>
  bool any(const Check& check)
  {
    bool hit = false;
    for (std::size_t i = 0; i < order_.size() && !hit; ++i)
    {
      const std::uint32_t number = order_[i];
      cost_[number] += kLeastCost;
      hit = check(number, cost_[number]);
      hits_[number] += hit ? 1.0 : 0.0;
    }
    learn();
    return hit;
  }

 private:
  static constexpr double kLeastCost = 1e-7;  // seconds: cost of a check that ends at its bounding boxes
  static constexpr std::uint64_t kStatesPerOrder = 512;

  /// Sorts the checks after 1, 2, 4, ... states, then after every kStatesPerOrder states.
  void learn()
  {
    const std::uint64_t states = ++states_;
    if (states % kStatesPerOrder != 0 && (states > kStatesPerOrder || (states & (states - 1)) != 0))
      return;
    std::sort(order_.begin(), order_.end(),
              [this](std::uint32_t a, std::uint32_t b)
              {
                const double gain_a = hits_[a] / cost_[a];
                const double gain_b = hits_[b] / cost_[b];
                return gain_a != gain_b ? gain_a > gain_b : a < b;
              });
  }

  std::vector<std::uint32_t> order_;
  std::vector<double> hits_;
  std::vector<double> cost_;  // total seconds
  std::uint64_t states_ = 0;
};
}  // namespace gpu_planning_scene::core
