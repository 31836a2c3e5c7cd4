#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "collision/checkers/resilient_checker.h"
#include "gpu_planning_scene/batch_checker_options.h"

namespace gpu_planning_scene::core
{
/// A checker for programs that need answers and not a certain device. If the device fails, also while it takes a new
/// scene, it is opened again and the call is repeated. If this fails too, the CPU answers (see ResilientChecker), and
/// `warn` gets one line. There is no time limit for a call.
class FallbackChecker : public StateChecker
{
 public:
  using Warn = std::function<void(const std::string&)>;

  /// `open` makes the checker on the device; it is called now and after a failure. Throws what it throws now. `warn` is
  /// called on the threads of the callers.
  FallbackChecker(std::shared_ptr<const PlanningScene> scene, ResilientChecker::Make open,
                  const BatchCheckerOptions& options, Warn warn);

  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  BatchResult check(const double* states, std::size_t count, const std::string& group = "",
                    const JointNeighbourhood* around = nullptr) override;
  SceneReport report(const std::string& group = "") override;
  std::string deviceName() const override { return checker_.deviceName(); }
  std::string deviceWarning() const override { return checker_.deviceWarning(); }

 private:
  void tell();

  ResilientChecker checker_;
  const Warn warn_;
  std::atomic<bool> on_cpu_{false};
};
}  // namespace gpu_planning_scene::core
