#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/method.h"
#include "gpu_planning_scene/cpu_checker.h"

namespace gpu_planning_scene::core::benchmark
{
/// The yardstick of answers: the exact checker, which `exactness` holds against the oracle, with everything in the
/// problem. What the methods under test leave out of theirs, this looks at.
class Truth
{
 public:
  explicit Truth(const std::shared_ptr<const PlanningScene>& scene);
  void setScene(const std::shared_ptr<const PlanningScene>& scene) { checker_.setScene(scene); }
  /// As Method::check.
  std::vector<std::uint8_t> check(const double* states, std::size_t count);

 private:
  CpuChecker checker_;
};

/// The share of 1 in answers.
double validShare(const std::vector<std::uint8_t>& answers);

/// How many answers are not those of `truth`, which may have more of them after `begin`, if the method is to be exact;
/// else 0.
std::size_t wrongAnswers(const MethodInfo& info, const std::vector<std::uint8_t>& answers,
                         const std::vector<std::uint8_t>& truth, std::size_t begin = 0);

/// Says on stderr where a method that is to be exact was wrong; nothing if `wrong` is 0. Returns `wrong`.
std::size_t tellWrong(const std::string& where, const MethodInfo& info, std::size_t wrong);
}  // namespace gpu_planning_scene::core::benchmark
