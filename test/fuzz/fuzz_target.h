#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "gpu_planning_scene/robot_model.h"

/// The entry point of libFuzzer. Without libFuzzer, replay_main.cpp calls it.
// NOLINTNEXTLINE(readability-identifier-naming): the name is libFuzzer's
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace gpu_planning_scene::core
{
/// Ends the program if the text has a line break, or if `must_say` is true and the text is empty.
void requireOneLine(const std::string& text, bool must_say);

/// Runs `action`. It may throw Error with one line of text. Any other exception ends the program.
void acceptOrRefuse(const std::function<void()>& action);

/// Mesh access that opens no file: a file named *.stl holds a tetrahedron, all other files cannot be read.
MeshAccess fuzzedMeshes();

/// A resolver that knows only the package `p`.
PackageResolver fuzzedPackages();

std::string textOf(const std::uint8_t* data, std::size_t size);

/// Computes link poses and adjacent links of a robot, which all other code depends on.
void useRobot(const RobotModel& robot);
}  // namespace gpu_planning_scene::core
