#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/batch_size.h"
#include "collision/gpu/broad_phase_order.h"
#include "collision/gpu/gpu_margins.h"
#include "collision/gpu/gpu_scene.h"
#include "collision/gpu/pose_source.h"
#include "collision/gpu/proofs/gpu_proofs.h"
#include "collision/gpu/traversal/gpu_traversal.h"
#include "gpu/readback.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
class GpuKinematics;

/// The GPU's results for a batch, one word per state: VERDICT_* or the colliding pair, see GpuPairChecker::pairOf.
using Verdicts = std::vector<std::uint32_t>;

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

  /// Checks `count` states. The poses must be in the frame of the world's poses, i.e. relative to
  /// CollisionProblem::origin.
  ///
  /// A batch goes to the device in parts. A part takes at most about `part_seconds`, and the next part is started
  /// before the results of the current one are fetched. A part whose lists overflow is split; a single state whose
  /// lists overflow is undecided. `margins`: for these states and pairs; null: none. `done`: called with the first
  /// state and the number of states as soon as their verdicts are there, while the device works on later parts.
  using Done = std::function<void(std::size_t begin, std::size_t count)>;
  void check(PoseSource& source, std::size_t count, Verdicts& verdicts, const Margins* margins, const Done& done);

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

  /// A batch: the source of its poses, its margins (or null), and the size of its parts.
  struct Batch
  {
    PoseSource& poses;
    const Margins* margins;
    BatchSize& parts;
    Verdicts& verdicts;
    const Done& done;
  };

  /// The states of a batch that the device works on together, and the buffers for their results.
  struct Part
  {
    std::size_t begin = 0;
    std::size_t count = 0;
    std::uint32_t serial = 0;
    Buffer answers;    // counters and verdicts on the device, see AnswerOffsets
    Readback fetched;  // the same, read back
  };

  void start(const Batch& batch, Part& part);
  void finish(const Batch& batch, Part& part);
  bool fetch(Part& part, Verdicts& verdicts);
  bool provesFirst(const Batch& batch) const;
  std::string faultOfProofs(const LaneScene& scene, GpuKinematics& kinematics);
  void findCandidates(std::uint32_t states);
  void writeQueries();
  void learnOrder(const Verdicts& verdicts);
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
