#pragma once

#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/bounds/displacement_bounds.h"
#include "collision/exact/cpu_traversal.h"
#include "collision/exact/forest_cache.h"
#include "collision/filter/proofs/robot_proofs.h"
#include "collision/gpu/gpu_kinematics.h"
#include "collision/gpu/gpu_pair_checker.h"
#include "collision/gpu/part_queue.h"
#include "collision/gpu/uploaded_poses.h"
#include "collision/problem/collision_problem.h"
#include "gpu/gl_thread.h"
#include "gpu_planning_scene/batch_checker_options.h"

namespace gpu_planning_scene::core
{
/// Checks a collision problem on a GPU. The states that float32 leaves undecided are decided on the CPU, by a traversal
/// of the same problem in double precision. One caller at a time, on any thread. Each method throws DeviceLost
/// if the device fails or its context is lost; the object is then unusable.
class GpuChecker
{
 public:
  /// Throws Error if there is no usable device, if a shader does not compile, or if max_batch is 0. `trees`: the CPU's
  /// trees for undecided states; other users may share them, one at a time. Null: its own trees.
  GpuChecker(const BatchCheckerOptions& options, std::shared_ptr<ForestCache> trees = nullptr);
  ~GpuChecker();

  /// Builds the trees. `robot`: the robot whose states are checked; null if the problem has no robot model. Throws
  /// Error and keeps the old problem if the device cannot hold the new one.
  void setProblem(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const RobotModel> robot = nullptr);

  /// Restricts the checked pairs to the pairs of `problem`, which must have the same trees and instances.
  void selectPairs(std::shared_ptr<const CollisionProblem> problem);

  /// From now on, these proofs decide pairs before trees do. They must be those of the selected problem's robot. Null,
  /// or the proofs of the last call: changes nothing. setProblem forgets them. If the device does not take them,
  /// `fault` says so, and trees decide all pairs.
  void useProofs(const std::shared_ptr<const RobotProofs>& proofs);

  /// Compiles the programs for batches with margins, if this has not been done, so that no check has to.
  void prepareMargins();

  /// One value per variable. The device can compute the link poses of a state if no variable exceeds its value in
  /// magnitude. Empty if this test does not suffice for the robot, or if the CPU computes the poses.
  std::vector<double> largestValues() const;

  /// Checks `count` states (rows of the robot's variables). Fills the result except for revision and seconds.
  /// `margins`: for these states and the selected pairs; null: none. `within_largest`: no value is beyond
  /// largestValues(), so the states need not be tested.
  void check(const double* states, std::size_t count, BatchResult& result, const Margins* margins = nullptr,
             bool within_largest = false);

  /// The same for link poses that the caller computes.
  void checkPoses(std::size_t count, std::size_t link_count, const UploadedPoses::LinkPoses& link_poses,
                  BatchResult& result);

  /// Work of the last batch.
  const GpuWork& lastWork() const { return pairs_->lastWork(); }

  const Device& device() const { return gl_.device(); }
  /// One line if the device's arithmetic, or its forward kinematics of the robot, is not as the error bounds assume.
  /// The CPU then does the affected work. Else empty.
  std::string fault() const;

 private:
  using LinkPoses = UploadedPoses::LinkPoses;
  void release();
  void restore();
  void requireUsableScene() const;
  /// Starts `job` on the thread of the OpenGL context. If the device runs out of memory, the scene counts as unusable
  /// and the future throws DeviceLost.
  std::future<void> startOnDevice(std::function<void()> job);
  void apply(const CollisionProblem& problem, const std::shared_ptr<const RobotModel>& robot);
  void check(PoseSource& source, std::size_t count, std::size_t link_count, const LinkPoses& link_poses,
             const Margins* margins, BatchResult& result);
  void settle(const StateRange& part, std::size_t link_count, const LinkPoses& link_poses, const Margins* margins,
              BatchResult& result);
  void settleOnCpu(const std::vector<std::size_t>& rows, std::size_t link_count, const LinkPoses& link_poses,
                   const Margins* margins, BatchResult& result);

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
  std::shared_ptr<const RobotProofs> proofs_;  // of the last useProofs
  std::string proofs_fault_;
  bool usable_ = false;  // the device holds exactly `problem_`
  std::shared_ptr<ForestCache> trees_;
  Verdicts verdicts_;  // of the last batch; kept, because new memory takes longer than the verdicts
  std::unique_ptr<const CpuTraversal> on_cpu_;  // for the selected pairs; built when a state is undecided
};
}  // namespace gpu_planning_scene::core
