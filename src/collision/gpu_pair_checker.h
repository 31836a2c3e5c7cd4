#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "collision/gpu_scene.h"
#include "collision/gpu_traversal.h"

namespace gpu_planning_scene
{
/// What the GPU found of a batch. A state without a flag is free.
struct Verdicts
{
  std::vector<std::uint32_t> flags;  ///< STATE_* bits, one word a state
  std::vector<std::uint32_t> hits;   ///< where STATE_HIT is set: the pair, see pairOf
};

/// Checks the pairs of a collision problem in many states, given the poses of the robot's instances: broad phase, root
/// boxes, traversal, triangles. Knows nothing of joints. Used on the context's thread.
class GpuPairChecker
{
 public:
  /// At most `max_states` states go to the GPU at once. `capacities`: 0 where the default for that many states is
  /// wanted.
  GpuPairChecker(const std::string& shader_folder, Traversal traversal, std::size_t max_states,
                 const ListCapacities& capacities = {});

  /// See GpuScene.
  void setProblem(const CollisionProblem& problem);
  void selectPairs(const CollisionProblem& problem);
  const GpuScene& scene() const { return scene_; }

  /// What is wrong with the device's float arithmetic, in one line; then every triangle test leaves its state
  /// undecided. Empty where it is as docs/error_bounds.md assumes.
  const std::string& floatFault() const { return float_fault_; }

  /// `poses`: state by state, 12 floats for each robot instance (writePoseRows), relative to the frame of the world's
  /// poses. A part of the batch whose lists overflow is split; a single state that still overflows is undecided.
  void check(const float* poses, std::size_t count, Verdicts& verdicts);

  /// Indices of a reported pair: into CollisionProblem::robot, and into robot, world and half-spaces in succession.
  static std::pair<std::uint32_t, std::uint32_t> pairOf(std::uint32_t hit);

 private:
  void checkPart(const float* poses, std::size_t begin, std::size_t count, Verdicts& verdicts);
  bool runBatch(const float* poses, std::size_t count);
  void testHalfSpaces(std::uint32_t states);
  void findCandidates(std::uint32_t states);
  void testRoots();
  bool traverse();
  void testContainment();

  std::string float_fault_;
  std::string definitions_;  // of the programs that test triangles
  GpuScene scene_;
  std::size_t max_states_;
  std::size_t part_;  // states that go to the GPU at once: fewer than max_states_ after an overflow
  BatchLists lists_;
  std::unique_ptr<GpuTraversal> traversal_;
  ArgumentsKernel arguments_;
  Program spheres_program_, self_program_, world_program_, roots_program_, half_spaces_program_, inside_program_;
  TexelBuffer poses_, spheres_;
};
}  // namespace gpu_planning_scene
