#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/gpu/broad_phase/broad_phase_order.h"
#include "collision/gpu/part_source.h"
#include "collision/gpu/problem/gpu_margins.h"
#include "collision/gpu/problem/gpu_scene.h"
#include "collision/gpu/problem/pose_source.h"
#include "collision/gpu/proofs/gpu_proofs.h"
#include "collision/gpu/traversal/gpu_traversal.h"
#include "collision/problem/batch_size.h"
#include "gpu/readback.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
class GpuKinematics;

/// A verdict of the GPU is a word: VERDICT_*, or the colliding pair, see GpuPairChecker::pairOf.
inline bool isFree(std::uint32_t verdict)
{
  return verdict == VERDICT_FREE || verdict == VERDICT_OPEN;
}

inline bool isHit(std::uint32_t verdict)
{
  return !isFree(verdict) && verdict != VERDICT_UNDECIDED;
}

/// Checks the pairs of a collision problem in many states, given the poses of the robot's instances. The steps are the
/// broad phase, the root boxes, the traversal and the triangles. The class knows no joints. Used on the context's
/// thread.
class GpuPairChecker
{
 public:
  /// Wanted duration of a part. Some devices abort work that takes seconds, and other users of the device wait until a
  /// part has ended.
  static constexpr double kPartSeconds = 0.05;

  /// At most `max_states` states go to the GPU at once. `capacities`: 0 means a default for the number of states.
  GpuPairChecker(const std::string& shader_folder, Traversal traversal, std::size_t max_states,
                 const ListCapacities& capacities = {}, double part_seconds = kPartSeconds);

  /// See GpuScene.
  void setProblem(const CollisionProblem& problem);
  void selectPairs(const CollisionProblem& problem);

  /// From now on, the proofs of a scene come first, until the next setProblem or selectPairs. The scene is that of the
  /// last of these two calls, made with lanes::kDeviceRounding. `kinematics`: of its robot; its states change. Batches
  /// must have their states on the device (see PoseSource::boundVariables). Throws Error, and uses no proofs, if a
  /// program does not compile, or if the device places frames elsewhere than the robot model.
  void useProofs(const LaneScene& scene, GpuKinematics& kinematics);
  const GpuScene& scene() const { return scene_; }

  /// Compiles the programs for batches with margins, if this has not been done.
  void prepareMargins();

  /// The fault of the device's float32 arithmetic in one line, or empty if it is as docs/error_bounds.md assumes. With
  /// a fault, each triangle test leaves its state undecided.
  const std::string& floatFault() const { return float_fault_; }

  /// Checks the states of `parts` until there is none. The poses must be in the frame of the world's poses, i.e.
  /// relative to CollisionProblem::origin.
  ///
  /// A part takes at most about `part_seconds`. The next part is started before the results of the current one are
  /// fetched, so the device works while verdicts are brought. A part whose lists overflow is split; a single state
  /// whose lists overflow is undecided. `margins`: for these states and pairs; null: none.
  void check(PoseSource& source, PartSource& parts, const Margins* margins);

  /// Work of the last check. A part whose lists overflowed counts only after it has been split.
  const GpuWork& lastWork() const { return work_; }

  /// The indices of a reported pair. The first is an index into CollisionProblem::robot; the second counts the robot's
  /// instances, then the world's, then the half-spaces.
  static std::pair<std::uint32_t, std::uint32_t> pairOf(std::uint32_t hit);

 private:
  /// The programs that run before the traversal. There is one set for batches without margins, and one with margins.
  struct Programs
  {
    Programs(const std::string& folder, const std::string& definitions);
    Program spheres, world, self, roots, half_spaces;
  };

  /// The work of a call of `check`: the source of poses and of states, margins (or null), and the size of parts.
  struct Work
  {
    PoseSource& poses;
    PartSource& parts;
    const Margins* margins;
    BatchSize& size;
  };

  /// The states that the device works on together, and the buffers for their results.
  struct Part
  {
    StateRange states;
    std::uint32_t serial = 0;
    Buffer answers;    // counters and verdicts on the device, see AnswerOffsets
    Readback fetched;  // the same, read back
  };

  std::size_t largestPart(const Work& work) const;
  void bringFree(PartSource& parts) const;
  void start(const Work& work, Part& part);
  void finish(const Work& work, Part& part);
  bool fetch(const Work& of, Part& part);
  bool provesFirst(const Work& work) const;
  std::string faultOfProofs(const LaneScene& scene, GpuKinematics& kinematics);
  void findCandidates(std::uint32_t states);
  void writeQueries();
  void learnOrder(const std::uint32_t* verdicts, std::size_t count);
  void testRoots();
  void testHalfSpaces();
  TraversalTask task(bool solids, bool padded) const;
  void prepare();
  void prepareTraversal(bool padded);
  void traverse(bool padded);
  void testContainment();

  std::string float_fault_;
  std::string definitions_;  // for the programs that test triangles
  GpuScene scene_;
  std::size_t max_states_;
  BatchSize plain_parts_, parts_with_margins_;
  std::uint32_t serial_ = 0;
  std::array<Part, 2> parts_;
  GpuWork work_;
  BatchLists lists_;
  std::unique_ptr<GpuTraversal> traversal_;
  std::string folder_;
  Programs plain_;
  std::optional<Programs> with_margins_;  // compiled when first needed
  const Programs* programs_ = &plain_;    // programs of the current batch
  Program inside_program_, done_program_;
  GpuMargins margins_;
  GpuProofs proofs_;
  TexelBuffer poses_, spheres_, world_queries_, self_queries_;
  BroadPhaseOrder order_;
  BroadPhaseQueries queries_;
};
}  // namespace gpu_planning_scene::core
