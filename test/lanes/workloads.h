#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// Small tasks for the simulated device (gl_device.h), which must have replaced OpenGL.
std::vector<std::string> workloadNames();

/// Runs a task with the shaders of a folder. Returns what was wrong, one line each: the faults that the device
/// reports, answers that differ from those of the exact checker, and results beyond the bounds of docs/error_bounds.md.
/// The seed decides the schedule, the arithmetic and the task's numbers.
std::vector<std::string> runWorkload(const std::string& name, const std::string& shaders, std::uint64_t seed);

// The tasks in which functions of the shaders are compared with their bounds. Each returns wrong results.
std::vector<std::string> checkTransforms(const std::string& shaders, std::uint64_t seed);
std::vector<std::string> checkTriangles(const std::string& shaders, std::uint64_t seed);
std::vector<std::string> checkDistances(const std::string& shaders, std::uint64_t seed);
std::vector<std::string> checkKinematics(const std::string& shaders, std::uint64_t seed);
std::vector<std::string> checkCrossings(const std::string& shaders, std::uint64_t seed);
std::vector<std::string> checkContainment(const std::string& shaders, std::uint64_t seed);
std::vector<std::string> checkSolids(const std::string& shaders, std::uint64_t seed);
std::vector<std::string> checkBoxes(const std::string& shaders, std::uint64_t seed);
// Two links far from the origin: the checker's answers, compared with those of the exact checker.
std::vector<std::string> checkFarLinks(const std::string& shaders, std::uint64_t seed);
// States near contact that balls and joint tables decide: the checker's answers, compared with those of the exact
// checker.
std::vector<std::string> checkProofs(const std::string& shaders, std::uint64_t seed);
std::vector<std::string> checkTurningBoxes(const std::string& shaders, std::uint64_t seed);
// Two centres of balls, far from the origin and near each other.
std::vector<std::string> checkBalls(const std::string& shaders, std::uint64_t seed);
// A box near a half-space: the checker's answers, compared with those of the exact checker.
std::vector<std::string> checkHalfSpaces(const std::string& shaders, std::uint64_t seed);
}  // namespace gpu_planning_scene::core
