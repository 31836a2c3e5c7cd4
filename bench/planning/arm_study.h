#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "command_line/command_line.h"
#include "support/arms.h"

namespace gpu_planning_scene::core::benchmark
{
/// The options that studies of real arms have in common.
struct ArmStudySettings
{
  explicit ArmStudySettings(const CommandLine& arguments);
  /// `count`: the option for the number of queries.
  static std::vector<Option> options(const Option& count);

  std::vector<Arm> arms;
  std::uint64_t seed;
  std::string out;  ///< folder of the tables
};
}  // namespace gpu_planning_scene::core::benchmark
