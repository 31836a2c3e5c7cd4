#include "planning/arm_study.h"

namespace gpu_planning_scene::core::benchmark
{
ArmStudySettings::ArmStudySettings(const CommandLine& arguments)
  : seed(arguments.count("--seed", 1, 0, 1000000000)), out(arguments.value("--out", "."))
{
  for (const Arm& arm : realArms())
    if (arm.name.find(arguments.value("--arm", "")) != std::string::npos)
      arms.push_back(arm);
}

std::vector<Option> ArmStudySettings::options(const Option& count)
{
  return {count,
          {"--arm", "TEXT", "only arms with this text in their name"},
          {"--seed", "N", "of the random numbers (1)"},
          {"--out", "FOLDER", "folder of the table (.)"}};
}
}  // namespace gpu_planning_scene::core::benchmark
