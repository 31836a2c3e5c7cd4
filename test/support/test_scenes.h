#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A real robot among obstacles, and the ranges that its random states are drawn from: such that 10 to 90 % of the
/// states are free and at least 5 % hit the world. Tests and benchmarks share these scenes.
struct TestScene
{
  std::string name;
  std::shared_ptr<const PlanningScene> scene;
  std::vector<double> lower;  // per variable
  std::vector<double> upper;

  /// `count` rows, uniform in the ranges; the same for the same seed.
  std::vector<double> randomStates(std::size_t count, std::uint64_t seed) const;
};

/// "kr5", "kr5_crowded" (hundreds of objects), "wam", "drchubo", "ur5_SET" for the seven sets of problems.
const std::vector<std::string>& testSceneNames();

/// Those, and more: "kr5_boxes" (8 boxes), "kr5_shelf", "drchubo_table", "drchubo_corridor"; and "arm_boxes" and
/// "arm_shelf", whose robot the project makes itself, so that they can be had anywhere.
const std::vector<std::string>& benchmarkSceneNames();

/// Which file or folder the scene needs that is not there; empty if it can be loaded.
std::string missingFor(const std::string& name);

/// Reads the scene's robot once more, without the matrix that testScene() may have generated: what loading takes.
std::shared_ptr<const RobotModel> loadRobotOf(const std::string& name);

/// The same scene with all links padded (metres).
TestScene withPadding(const TestScene& scene, double padding);

/// Loads a scene, once per process.
const TestScene& testScene(const std::string& name);
}  // namespace gpu_planning_scene::core
