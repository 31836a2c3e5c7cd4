#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "benchmark/method.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core::benchmark
{
/// Scenes in which one object was moved, and the true answers for these scenes.
class Updates
{
 public:
  struct Result
  {
    std::vector<double> seconds;  ///< of each update; empty if the method cannot update, or without objects
    std::size_t wrong = 0;        ///< wrong answers, if the method claims to be exact
  };

  /// `repeats`: number of measured updates. One more update before them is not measured.
  Updates(const TestScene& scene, std::size_t repeats);

  /// Measures the time from the update of the method to its answer for one state of the new scene. The construction of
  /// the scene is not measured. After each update, the answers for more states are compared with the truth.
  Result measure(const MethodInfo& info, Method& method) const;

 private:
  struct Update
  {
    std::shared_ptr<const PlanningScene> scene;
    std::vector<std::uint8_t> truth;
  };
  std::vector<double> states_;
  std::vector<Update> updates_;
};
}  // namespace gpu_planning_scene::core::benchmark
