#pragma once

#include <cstdint>
#include <functional>
#include <string>

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

/// Asks every method about cases 0 .. count - 1 of a family and holds the answers against the oracle's. `report` is
/// told of every wrong answer of the project's own methods. Throws Error if the oracle contradicts a case's
/// construction.
Row judge(const Family& family, std::uint64_t seed, std::size_t count, Ours& ours,
          const std::function<void(const Failure&)>& report);
}  // namespace gpu_planning_scene::core::stability
