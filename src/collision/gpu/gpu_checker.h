#pragma once

#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/bounds/displacement_bounds.h"
#include "collision/cpu/lanes/lane_scene.h"
#include "collision/exact/exact_checker.h"
#include "collision/exact/forest_cache.h"
#include "collision/gpu/gpu_pair_checker.h"
#include "collision/gpu/part_source.h"
#include "collision/gpu/problem/gpu_kinematics.h"
#include "collision/gpu/problem/placeable_states.h"
#include "collision/gpu/problem/uploaded_poses.h"
#include "collision/problem/collision_problem.h"
#include "collision/proofs/robot_proofs.h"
#include "gpu/gl_thread.h"
#include "gpu_planning_scene/batch_checker_options.h"

namespace gpu_planning_scene::core
{
/// Checks a collision problem on a GPU. float32 leaves some states undecided. One caller at a time, on any thread. Each
/// method throws DeviceLost if the device fails or its context is lost; the object is then unusable.
class GpuChecker
{
 public:
  /// Throws Error if there is no usable device, if a shader does not compile, or if max_batch is 0. `trees`: the CPU's
  /// trees for the undecided states of `check` with a result and of `checkPoses`; other users may share them, one at a
  /// time. Null: its own trees.
  explicit GpuChecker(const BatchCheckerOptions& options, std::shared_ptr<ForestCache> trees = nullptr);
  ~GpuChecker();

  /// Builds the trees. `robot`: the robot whose states are checked; null if the problem has no robot model. Throws
  /// Error and keeps the old problem if the device cannot hold the new one.
  void setProblem(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const RobotModel> robot = nullptr);

  /// Restricts the checked pairs to the pairs of `problem`, which must have the same trees and instances.
  void selectPairs(std::shared_ptr<const CollisionProblem> problem);

  /// From now on, proofs decide pairs before trees do. `scene`: of the selected problem and its robot, made with
  /// lanes::kDeviceRounding. Null, or the scene of the last call: changes nothing. setProblem and selectPairs forget
  /// it. If the device does not take it, `fault` says so, and trees decide all pairs.
  void useProofs(const std::shared_ptr<const LaneScene>& scene);

  /// Checks the states of `parts` until there is none, and brings their verdicts. Each state is in PlaceableStates.
  /// `margins`: for these states and the selected pairs; null: none.
  void check(PartSource& parts, const Margins* margins = nullptr);

  /// Writes the verdicts of states that a PartSource has got, on all cores: 0 and the pair for each one that collides.
  /// Returns the undecided ones, in ascending order. Leaves the rows of the others as they are.
  std::vector<std::size_t> write(const StateRange& states, const std::uint32_t* verdicts, BatchResult& result) const;

  /// Checks `count` states, whatever their values are, and decides undecided ones on the CPU. Fills the result except
  /// for revision and seconds.
  void check(const double* states, std::size_t count, BatchResult& result, const Margins* margins = nullptr);

  /// The same for link poses that the caller computes.
  void checkPoses(std::size_t count, std::size_t link_count, const UploadedPoses::LinkPoses& link_poses,
                  BatchResult& result);

  /// Work of the last check.
  const GpuWork& lastWork() const { return pairs_->lastWork(); }

  const Device& device() const { return gl_.device(); }
  /// One line if the device's arithmetic, or its forward kinematics of the robot, is not as the error bounds assume.
  /// The CPU then does the affected work. Else empty.
  std::string fault() const;

 private:
  using LinkPoses = UploadedPoses::LinkPoses;
  /// The bodies of a verdict that is a hit, in ascending order.
  BodyPair bodiesOf(std::uint32_t hit) const;
  void release();
  void restore();
  void makeTraversal();
  void requireUsableScene() const;
  /// Starts `job` on the thread of the OpenGL context. If the device runs out of memory, the scene counts as unusable
  /// and the future throws DeviceLost.
  std::future<void> startOnDevice(std::function<void()> job);
  void apply(const CollisionProblem& problem, const std::shared_ptr<const RobotModel>& robot);
  void check(PoseSource& source, PartSource& parts, const Margins* margins);
  void checkAll(PoseSource& source, std::size_t count, std::size_t link_count, const LinkPoses& link_poses,
                const Margins* margins, BatchResult& result);
  void settleOnCpu(const std::vector<std::size_t>& rows, std::size_t link_count, const LinkPoses& link_poses,
                   const Margins* margins, BatchResult& result);
  bool placesLinks() const { return kinematics_ != nullptr && kinematics_fault_.empty(); }

  std::string shader_folder_;
  GlThread gl_;
  // `pairs_` and `kinematics_` are created, used and destroyed on the GL thread. `kinematics_` is null if the device's
  // double precision is not reliable, or if the robot has too many links. It is not used if it has a fault.
  std::unique_ptr<GpuPairChecker> pairs_;
  std::unique_ptr<GpuKinematics> kinematics_;
  std::string double_fault_;
  std::string kinematics_fault_;
  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const LaneScene> proofs_;  // of the last useProofs
  std::string proofs_fault_;
  bool usable_ = false;  // the device holds exactly `problem_`
  std::shared_ptr<ForestCache> trees_;
  std::unique_ptr<const ExactChecker> on_cpu_;  // for the selected pairs; built when a state is undecided
};
}  // namespace gpu_planning_scene::core
