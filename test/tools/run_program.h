#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
struct ProgramOutput
{
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs a program to its end. Throws std::runtime_error if it cannot be started.
ProgramOutput runProgram(const std::string& path, const std::vector<std::string>& arguments);

std::vector<std::string> linesOf(const std::string& text);
}  // namespace gpu_planning_scene::core
