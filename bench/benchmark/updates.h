#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "benchmark/method.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core::benchmark
{
/// Scenes in which one object was moved, and the true answers in them.
class Updates
{
 public:
  struct Result
  {
    std::vector<double> seconds;  ///< of each; none for a method that has to be built anew, or without objects
    std::size_t wrong = 0;        ///< answers, if the method is to be exact
  };

  /// `repeats`: updates that are measured, after one that is not.
  Updates(const TestScene& scene, std::size_t repeats);

  /// How long it takes from giving a method a scene to its answer about one state in that scene; making the scene is
  /// not counted. Then it is asked about more states, to be compared with the truth.
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
