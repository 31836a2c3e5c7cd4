#include "benchmark/truth.h"

#include <algorithm>
#include <iostream>

namespace gpu_planning_scene::core::benchmark
{
namespace
{
CheckerOptions withEverything()
{
  CheckerOptions options;
  options.reductions = Reductions::none();
  return options;
}
}  // namespace

Truth::Truth(const std::shared_ptr<const PlanningScene>& scene) : checker_(scene, withEverything()) {}

std::vector<std::uint8_t> Truth::check(const double* states, std::size_t count)
{
  return checker_.check(states, count).valid;
}

double validShare(const std::vector<std::uint8_t>& answers)
{
  return static_cast<double>(std::count(answers.begin(), answers.end(), 1)) / static_cast<double>(answers.size());
}

std::size_t wrongAnswers(const MethodInfo& info, const std::vector<std::uint8_t>& answers,
                         const std::vector<std::uint8_t>& truth, std::size_t begin)
{
  std::size_t wrong = 0;
  for (std::size_t i = 0; info.exact && i < answers.size(); ++i)
    wrong += answers[i] != truth[begin + i] ? 1 : 0;
  return wrong;
}

std::size_t reportWrongAnswers(const std::string& where, const MethodInfo& info, std::size_t wrong)
{
  if (wrong > 0)
    std::cerr << where << ": " << info.title << " gives " << wrong << " wrong answers\n";
  return wrong;
}
}  // namespace gpu_planning_scene::core::benchmark
