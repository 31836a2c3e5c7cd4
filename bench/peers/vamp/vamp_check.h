#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core::benchmark
{
struct VampLibrary;
struct VampWorld;

/// VAMP has no cylinders. Its own script for the problems of MotionBenchMaker replaces a cylinder by a capsule with the
/// same axis and radius, which adds a half-ball at each end. In the set "box", the script replaces a cylinder by a box
/// around it.
enum class VampCylinders
{
  Capsules,
  Boxes
};

/// The shape by which VAMP's script replaces the cylinders of a test scene or of a set of problems. `name`: see
/// PlanningScene::name.
VampCylinders vampCylindersOf(const std::string& name);

/// The reason why VAMP cannot be used here: the build found no VAMP, or the processor lacks AVX2. Empty: it can be
/// used.
std::string whyNoVamp();

/// The reason why VAMP cannot check a scene: another robot, a mesh, a cone, a half-space, an attached object, a padding
/// or a scale. Empty: it can check the scene.
std::string whyVampRefuses(const PlanningScene& scene);

/// VAMP's check of the ur5 in one scene. Concurrent calls of check() are safe.
class VampCheck
{
 public:
  /// Throws Error if VAMP cannot be used, or cannot check the scene.
  VampCheck(const PlanningScene& scene, VampCylinders cylinders);

  /// `states`: count rows with one value per variable of the robot. One byte per state: 1 free, 0 in collision.
  void check(const double* states, std::size_t count, std::uint8_t* valid) const;

 private:
  const VampLibrary& library_;
  std::size_t width_;
  std::vector<std::size_t> columns_;  // of VAMP's joints in a state
  std::shared_ptr<VampWorld> world_;
};
}  // namespace gpu_planning_scene::core::benchmark
