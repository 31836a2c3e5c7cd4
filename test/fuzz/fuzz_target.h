#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "gpu_planning_scene/robot_model.h"

/// What libFuzzer calls, and replay_main.cpp in its place.
// NOLINTNEXTLINE(readability-identifier-naming): the name is libFuzzer's
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace gpu_planning_scene::core
{
/// Ends the program if the text has a line break or, where it `must_say` something, is empty.
void requireOneLine(const std::string& text, bool must_say);

/// Runs `action`. It may throw Error, with one line of text; anything else that it throws ends the program.
void acceptOrRefuse(const std::function<void()>& action);

/// No file is opened: mesh files that are called *.stl hold a tetrahedron, all others cannot be read.
MeshAccess fuzzedMeshes();

/// Knows the package `p` alone.
PackageResolver fuzzedPackages();

std::string textOf(const std::uint8_t* data, std::size_t size);

/// Asks a robot for what everything else builds on.
void useRobot(const RobotModel& robot);
}  // namespace gpu_planning_scene::core
