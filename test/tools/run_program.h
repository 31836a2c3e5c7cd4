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

/// Runs a program to its end. The exit code is 127 if it cannot be executed, and 128 plus the signal if a signal ended
/// it. Throws std::runtime_error if no process can be created.
ProgramOutput runProgram(const std::string& path, const std::vector<std::string>& arguments);

/// The same, with a terminal as the standard output.
ProgramOutput runOnTerminal(const std::string& path, const std::vector<std::string>& arguments);

std::vector<std::string> linesOf(const std::string& text);
}  // namespace gpu_planning_scene::core
