#pragma once

#include <memory>
#include <string>

#include "gpu_planning_scene/batch_checker_options.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Checks large batches of states on the GPU, and small ones on the CPU (BatchCheckerOptions::cpu_below). On the GPU:
/// forward kinematics, tests of bounding volumes, tree traversal, triangle tests. Float arithmetic leaves few states
/// undecided. The CPU decides these with its own trees, in double precision. A BatchChecker owns a GL context and the
/// thread on which the context is current. Thread-safe: calls are served one after the other.
///
/// A. Gress, G. Zachmann: Object-Space Interference Detection on Programmable Graphics Hardware (2003).
class BatchChecker : public StateChecker
{
 public:
  /// Throws Error if no EGL device can be used (the message lists the devices that were tried), if a shader does not
  /// compile (the message has its log), or if the scene or an option is not valid.
  explicit BatchChecker(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options = {});
  ~BatchChecker() override;

  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  BatchResult check(const double* states, std::size_t count, const std::string& group = "",
                    const JointNeighbourhood* around = nullptr) override;
  SceneReport report(const std::string& group = "") override;
  std::string deviceName() const override;
  std::string deviceWarning() const override;
  /// The work of the last call of `check`. The GPU counts it in any case, so this call costs nothing.
  GpuWork lastWork() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
