#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "gpu_planning_scene/planning_scene.h"
#include "tools/command_line.h"

namespace gpu_planning_scene::core
{
/// The states that a tool checks, handed out piece by piece so that many random ones need no memory.
class StateSource
{
 public:
  virtual ~StateSource() = default;
  virtual std::size_t count() const = 0;
  /// For a person: how many, and where they come from.
  virtual std::string text() const = 0;
  /// The next `count` states, row-major; valid until the next call.
  virtual const double* next(std::size_t count) = 0;
};

/// --states, --random and --seed.
std::vector<Option> stateOptions();
/// What those ask for. `scene` must outlive it. Throws UsageError unless exactly one of --states and --random is given.
std::unique_ptr<StateSource> stateSourceFrom(const CommandLine& arguments, const PlanningScene& scene);
}  // namespace gpu_planning_scene::core
