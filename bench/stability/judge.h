#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "stability/literature_methods.h"
#include "stability/ours.h"
#include "stability/table.h"

namespace gpu_planning_scene::core::stability
{
struct Failure
{
  std::string family;
  std::size_t index;
  Method method;
  std::string what;
};

/// Runs every method on cases 0 .. count - 1 of a family and compares the answers with the oracle. Calls `report` for
/// every wrong answer of the project's own methods. Throws Error if the oracle contradicts the construction of a case.
Row judge(const Family& family, std::uint64_t seed, std::size_t count, Ours& ours, const LiteratureMethods& literature,
          const std::function<void(const Failure&)>& report);
}  // namespace gpu_planning_scene::core::stability
