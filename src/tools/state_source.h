#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "command_line/command_line.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The states that a tool checks. They are handed out in parts, so that many random states need little memory.
class StateSource
{
 public:
  virtual ~StateSource() = default;
  virtual std::size_t count() const = 0;
  /// Text for the user: the number of states and their origin.
  virtual std::string text() const = 0;
  /// One line about values outside the joint limits; empty if there are none.
  virtual std::string warning() const { return {}; }
  /// The next `count` states, row-major; valid until the next call.
  virtual const double* next(std::size_t count) = 0;
};

/// --states, --state, --random, --random-base and --seed.
std::vector<Option> stateOptions();
/// Throws UsageError unless exactly one of --states, --state and --random is given, and for an option that needs
/// --random. Reads no file.
void checkStateUsage(const CommandLine& arguments);
/// The states of these options. `scene` must outlive the source. Throws as checkStateUsage, UsageError for a wrong
/// --state, and Error for a wrong file.
std::unique_ptr<StateSource> stateSourceFrom(const CommandLine& arguments, const PlanningScene& scene);
}  // namespace gpu_planning_scene::core
