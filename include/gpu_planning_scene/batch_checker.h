#pragma once

#include <memory>
#include <string>

#include "gpu_planning_scene/batch_checker_options.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Checks states on the GPU: forward kinematics, root tests, tree traversal, triangle tests; undecided states go to a
/// double-precision traversal of the same trees on the CPU. Owns a GL context and the thread that it is current on.
class BatchChecker : public StateChecker
{
 public:
  /// Throws Error: no usable EGL device (lists what was tried), a shader that does not compile (with its log).
  BatchChecker(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options);
  ~BatchChecker() override;

  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  BatchResult check(const double* states, std::size_t count, const std::string& group = "",
                    const JointNeighbourhood* around = nullptr) override;
  SceneReport report(const std::string& group = "") override;
  std::string deviceName() const override;
  std::string deviceWarning() const override;
  /// Of the last call of `check`. The GPU counts these in any case: to know them costs nothing.
  GpuWork lastWork() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
