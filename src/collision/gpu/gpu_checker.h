#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/bounds/displacement_bounds.h"
#include "collision/exact/cpu_traversal.h"
#include "collision/exact/forest_cache.h"
#include "collision/gpu/gpu_kinematics.h"
#include "collision/gpu/gpu_pair_checker.h"
#include "collision/gpu/uploaded_poses.h"
#include "collision/problem/collision_problem.h"
#include "gpu/gl_thread.h"
#include "gpu_planning_scene/batch_checker_options.h"

namespace gpu_planning_scene::core
{
/// A collision problem on a GPU, with the CPU behind it: states that floats leave undecided go to a double-precision
/// traversal of the same trees. One caller at a time; any thread. Each method throws DeviceLost where the device fails
/// or its context is lost; then nothing more comes of this engine.
class GpuChecker
{
 public:
  /// Throws Error: no usable device, a shader that does not compile, max_batch of 0.
  /// `trees`: the CPU's, for undecided states; others may use them too, one at a time. Null: its own.
  GpuChecker(const BatchCheckerOptions& options, std::shared_ptr<ForestCache> trees = nullptr);
  ~GpuChecker();

  /// Builds the trees. `robot`: whose states are checked; null for a problem that is no robot's. Throws Error and keeps
  /// the old problem if the device cannot hold the new one.
  void setProblem(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const RobotModel> robot = nullptr);

  /// Restricts the checked pairs to those of `problem`, which has the same trees and instances.
  void selectPairs(std::shared_ptr<const CollisionProblem> problem);

  /// Compiles what batches with margins need, unless that is done, so that no check has to.
  void prepareMargins();

  /// Checks `count` rows of the robot's variables: fills the result but for revision and seconds. `margins`: for these
  /// rows and the selected pairs; null: none.
  void check(const double* states, std::size_t count, BatchResult& result, const Margins* margins = nullptr);

  /// The same for poses that the caller finds.
  void checkPoses(std::size_t count, std::size_t link_count, const UploadedPoses::LinkPoses& link_poses,
                  BatchResult& result);

  /// Of the last batch.
  const GpuWork& lastWork() const { return pairs_->lastWork(); }

  const Device& device() const { return gl_.device(); }
  /// See GpuPairChecker.
  const std::string& floatFault() const { return pairs_->floatFault(); }

 private:
  using LinkPoses = UploadedPoses::LinkPoses;
  void release();
  void restore();
  void refuseHalfBuilt() const;
  void apply(const CollisionProblem& problem, const std::shared_ptr<const RobotModel>& robot);
  void check(PoseSource& source, std::size_t count, std::size_t link_count, const LinkPoses& link_poses,
             const Margins* margins, BatchResult& result);
  void settleOnCpu(const std::vector<std::size_t>& rows, std::size_t link_count, const LinkPoses& link_poses,
                   const Margins* margins, BatchResult& result);

  std::string shader_folder_;
  GlThread gl_;
  // These two are made, used and destroyed on the GL thread. No kinematics where the device's double precision is not
  // good.
  std::unique_ptr<GpuPairChecker> pairs_;
  std::unique_ptr<GpuKinematics> kinematics_;
  std::string double_fault_;
  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const CollisionProblem> problem_;
  bool usable_ = false;  // the device has that problem, not a part of another
  std::shared_ptr<ForestCache> trees_;
  std::unique_ptr<const CpuTraversal> on_cpu_;  // of the selected pairs; made when a state is undecided
};
}  // namespace gpu_planning_scene::core
