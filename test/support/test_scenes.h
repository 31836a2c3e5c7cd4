#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A real robot among obstacles, and the ranges from which its random states are drawn. The ranges are chosen so that
/// 10 to 90 % of the states are free and at least 5 % hit the world. Tests and benchmarks share these scenes.
struct TestScene
{
  std::string name;
  std::shared_ptr<const PlanningScene> scene;
  std::vector<double> lower;  // per variable
  std::vector<double> upper;

  /// `count` rows, uniform in the ranges. The same seed gives the same states.
  std::vector<double> randomStates(std::size_t count, std::uint64_t seed) const;
};

/// "kr5", "kr5_crowded" (hundreds of objects), "wam", "drchubo", and "ur5_SET" for the seven sets of problems.
const std::vector<std::string>& testSceneNames();

/// The names of testSceneNames() and "kr5_boxes" (8 boxes), "kr5_shelf", "drchubo_table", "drchubo_corridor",
/// "arm_boxes", "arm_shelf", "arm_driven" (on a planar base, among boxes), "panda_boxes", "panda_shelf" and
/// "panda_table". The project generates the robot of the scenes arm_*, so they are available everywhere.
const std::vector<std::string>& benchmarkSceneNames();

/// The file or folder that the scene needs and that is missing; empty if the scene can be loaded.
std::string missingFor(const std::string& name);

/// Loads the scene's robot again, without the matrix that testScene() may generate. It serves to time the loading.
std::shared_ptr<const RobotModel> loadRobotOf(const std::string& name);

/// The same scene with all links padded (metres).
TestScene withPadding(const TestScene& scene, double padding);

/// Loads a scene, once per process.
const TestScene& testScene(std::string_view name);
}  // namespace gpu_planning_scene::core
