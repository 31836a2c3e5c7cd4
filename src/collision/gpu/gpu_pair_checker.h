#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/batch_size.h"
#include "collision/gpu/broad_phase_order.h"
#include "collision/gpu/gpu_margins.h"
#include "collision/gpu/gpu_scene.h"
#include "collision/gpu/pose_source.h"
#include "collision/gpu/traversal/gpu_traversal.h"
#include "gpu/readback.h"

namespace gpu_planning_scene::core
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

  /// Compiles what batches with margins need, unless that is done.
  void prepareMargins();

  /// What is wrong with the device's float arithmetic, in one line; then every triangle test leaves its state
  /// undecided. Empty where it is as docs/error_bounds.md assumes.
  const std::string& floatFault() const { return float_fault_; }

  /// The poses come relative to the frame of the world's poses. Batches go to the device part by part, the next one
  /// before the answers of the one before are fetched; a part takes about kPartSeconds at most. A part whose lists
  /// overflow is split; a single state that still overflows is undecided. `margins`: for these states and pairs; null:
  /// none.
  void check(PoseSource& source, std::size_t count, Verdicts& verdicts, const Margins* margins = nullptr);

  /// Of the last check; parts whose lists overflowed count once they were split.
  const GpuWork& lastWork() const { return work_; }

  /// Indices of a reported pair: into CollisionProblem::robot, and into robot, world and half-spaces in succession.
  static std::pair<std::uint32_t, std::uint32_t> pairOf(std::uint32_t hit);

 private:
  /// What is done before pairs are traversed: for batches without margins, and for those with.
  struct Programs
  {
    Programs(const std::string& folder, const std::string& definitions);
    Program spheres, world, self, roots, half_spaces;
  };

  /// A batch: where its poses come from, and its margins, or null.
  struct Batch
  {
    PoseSource& poses;
    const Margins* margins;
    BatchSize& parts;
  };

  /// States of a batch that are on their way through the device, and where their answers come to lie.
  struct Part
  {
    std::size_t begin = 0;
    std::size_t count = 0;
    std::uint32_t serial = 0;
    Buffer answers;    // counters, flags and hits, see AnswerOffsets
    Readback fetched;  // likewise
  };

  void start(const Batch& batch, Part& part);
  void finish(const Batch& batch, Part& part, Verdicts& verdicts);
  bool fetch(Part& part, Verdicts& verdicts);
  void testHalfSpaces(std::uint32_t states);
  void findCandidates(std::uint32_t states);
  void writeQueries();
  void learnOrder(const Verdicts& verdicts);
  void testRoots();
  TraversalTask task(bool solids, bool padded) const;
  void prepare();
  void traverse(bool padded);
  void testContainment();

  std::string float_fault_;
  std::string definitions_;  // of the programs that test triangles
  GpuScene scene_;
  std::size_t max_states_;
  BatchSize plain_parts_, parts_with_margins_;
  std::uint32_t serial_ = 0;
  std::array<Part, 2> parts_;
  GpuWork work_;
  BatchLists lists_;
  std::unique_ptr<GpuTraversal> traversal_;
  ArgumentsKernel arguments_;
  std::string folder_;
  Programs plain_;
  std::optional<Programs> with_margins_;  // when they are first needed
  const Programs* programs_ = &plain_;    // of the batch
  Program inside_program_, done_program_;
  GpuMargins margins_;
  TexelBuffer poses_, spheres_, world_queries_, self_queries_;
  BroadPhaseOrder order_;
  BroadPhaseQueries queries_;
};
}  // namespace gpu_planning_scene::core
