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
/// The reference for answers: the exact checker without reductions. It also checks the pairs that the tested methods
/// leave out. The program `exactness` compares the exact checker with the oracle.
class Truth
{
 public:
  explicit Truth(const std::shared_ptr<const PlanningScene>& scene);
  void setScene(const std::shared_ptr<const PlanningScene>& scene) { checker_.setScene(scene); }
  /// Same format as Method::check.
  std::vector<std::uint8_t> check(const double* states, std::size_t count);

 private:
  CpuChecker checker_;
};

/// The share of free states in the answers.
double validShare(const std::vector<std::uint8_t>& answers);

/// Number of answers that differ from `truth` if the method claims to be exact, else 0. `answers` begins at index
/// `begin` of `truth`, and `truth` may be longer.
std::size_t wrongAnswers(const MethodInfo& info, const std::vector<std::uint8_t>& answers,
                         const std::vector<std::uint8_t>& truth, std::size_t begin = 0);

/// Prints a line with `where` on stderr if `wrong` is above 0. Returns `wrong`.
std::size_t reportWrongAnswers(const std::string& where, const MethodInfo& info, std::size_t wrong);
}  // namespace gpu_planning_scene::core::benchmark
