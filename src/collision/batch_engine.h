#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/collision_problem.h"
#include "collision/cpu_traversal.h"
#include "collision/forest_cache.h"
#include "collision/gpu_pair_checker.h"
#include "gpu/gl_thread.h"
#include "gpu_planning_scene/batch_checker.h"

namespace gpu_planning_scene
{
/// A collision problem on a GPU, with the CPU behind it: states that floats leave undecided go to a double-precision
/// traversal of the same trees. One caller at a time; any thread.
class BatchEngine
{
 public:
  /// Throws Error: no usable device, a shader that does not compile, max_batch of 0.
  explicit BatchEngine(const BatchCheckerOptions& options);
  ~BatchEngine();

  /// Builds the trees. Throws Error and keeps the old problem if the device cannot hold the new one.
  void setProblem(std::shared_ptr<const CollisionProblem> problem);

  /// Restricts the checked pairs to those of `problem`, which has the same trees and instances.
  void selectPairs(std::shared_ptr<const CollisionProblem> problem);

  /// Writes the poses of all links (of bodies that CollisionProblem::robot names) in state `row`. Called from several
  /// threads.
  using LinkPoses = std::function<void(std::size_t row, Eigen::Isometry3d* link_poses)>;

  /// Checks `count` states of a robot of `link_count` links: fills the result but for revision and
  /// seconds.
  void check(std::size_t count, std::size_t link_count, const LinkPoses& link_poses, BatchResult& result);

  const Device& device() const { return gl_.device(); }
  /// See GpuPairChecker.
  const std::string& floatFault() const { return pairs_->floatFault(); }

 private:
  std::vector<float> instancePoses(std::size_t begin, std::size_t count, std::size_t link_count,
                                   const LinkPoses& link_poses) const;
  void settleOnCpu(const std::vector<std::size_t>& rows, std::size_t link_count, const LinkPoses& link_poses,
                   BatchResult& result);

  std::size_t max_batch_;
  GlThread gl_;
  std::unique_ptr<GpuPairChecker> pairs_;  // made, used and destroyed on the GL thread
  std::shared_ptr<const CollisionProblem> problem_;
  ForestCache trees_;                           // for the undecided states
  std::unique_ptr<const CpuTraversal> on_cpu_;  // of the selected pairs; made when a state is undecided
};
}  // namespace gpu_planning_scene
