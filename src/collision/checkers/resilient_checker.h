#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Events of a device since the start.
struct DeviceHistory
{
  std::uint64_t losses = 0;    ///< noticed losses of the device, or of one of several devices
  std::uint64_t rebuilds = 0;  ///< new checkers on the device after the first one
  std::uint64_t batches_on_cpu = 0;
  bool on_cpu = false;          ///< the CPU answers now
  bool rebuild_failed = false;  ///< the device was lost and has not been reopened successfully
  std::string last_error;       ///< last error of the device; empty: none
};

struct ResilientOptions
{
  /// If a call takes longer than this, the device counts as hanging and is never used again. Batches must be small
  /// enough to take far less time. The limit of a scene is device_seconds * (1 + millions of triangles), because their
  /// trees are built within the call. Infinite: no limit. Calls then run on the thread of the caller, and states are
  /// not copied.
  double device_seconds = 30.0;
  std::size_t max_losses = 3;  ///< after this many losses within loss_window seconds, the CPU answers
  double loss_window = 60.0;
  double retry_seconds = 60.0;  ///< time after which the device is tried again
};

/// A checker that survives the loss of its device. If the device is lost, it opens a new checker on the device with the
/// current scene and repeats the request. If this fails too, the CPU answers, and the device is tried again later. If
/// setScene of the device's checker fails, the checker is destroyed, so no answer ever comes from an incomplete scene.
/// If the CPU takes a scene and the device does not (e.g. because the scene is too large), the CPU answers for this
/// scene. The CPU and the device give the same verdicts.
///
/// With a time limit, one thread does all work on the device. If it hangs, it is abandoned together with the objects
/// that it uses, and the CPU answers from then on. So at most one thread is lost.
class ResilientChecker : public StateChecker
{
 public:
  using Make = std::function<std::unique_ptr<StateChecker>(std::shared_ptr<const PlanningScene>)>;
  enum class Opening
  {
    AtStart,  ///< no time limit for the device, and its errors are thrown: the program needs the device to start
    Later     ///< the time limit of a scene applies, and the CPU answers if the device fails
  };

  /// `device` is called immediately, `cpu` when it is first needed. `cpu` may throw only if the scene is invalid.
  ResilientChecker(std::shared_ptr<const PlanningScene> scene, Make device, Make cpu,
                   const ResilientOptions& options = {}, Opening opening = Opening::AtStart);
  ~ResilientChecker() override;

  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  BatchResult check(const double* states, std::size_t count, const std::string& group = "",
                    const JointNeighbourhood* around = nullptr) override;
  SceneReport report(const std::string& group = "") override;
  /// These three functions describe the device or CPU that answers now. They do not wait for a running check.
  std::string deviceName() const override;
  std::string deviceWarning() const override;
  DeviceHistory history() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
