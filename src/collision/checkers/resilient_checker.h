#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// What has become of a device since the start.
struct DeviceHistory
{
  std::uint64_t losses = 0;    ///< that were noticed
  std::uint64_t rebuilds = 0;  ///< new checkers on the device, after the first
  std::uint64_t batches_on_cpu = 0;
  bool on_cpu = false;          ///< the CPU answers at present
  bool rebuild_failed = false;  ///< the device was lost and could not be had again, so far
  std::string last_error;       ///< of the device; empty: none
};

struct ResilientOptions
{
  /// A call that takes longer is a lost device, which is given up for good; callers check as many states at once as
  /// take far less. For each million triangles of the scene the same once more: their trees are built within the call.
  double device_seconds = 30.0;
  std::size_t most_losses = 3;  ///< so many within loss_window seconds, and the CPU answers
  double loss_window = 60.0;
  double retry_seconds = 60.0;  ///< after which the device is tried again
};

/// Asks a device's checker; where that is lost it makes a new one, with the current scene, and asks again; where that
/// fails too the CPU answers, and the device is tried again later. A device's checker that could not take a scene is
/// dropped, so that nothing is ever answered from a half-built scene; a scene that the CPU takes and the device does
/// not, as it is too large, say, is the CPU's. Who answers changes no answer.
/// All work on the device is done on one thread of its own. Where that hangs, it is left behind with what it uses, and
/// from then on the CPU answers: at most one thread is lost so.
class ResilientChecker : public StateChecker
{
 public:
  using Make = std::function<std::unique_ptr<StateChecker>(std::shared_ptr<const PlanningScene>)>;
  enum class Opening
  {
    AtStart,  ///< the device may take as long as it likes, and what it throws is thrown: nothing can work without it
    Later     ///< the device has as long as for a scene, and the CPU stands in for it
  };

  /// `device` is called at once. `cpu` is called when it is first needed, and throws nothing but what the scene is to
  /// be blamed for.
  ResilientChecker(std::shared_ptr<const PlanningScene> scene, Make device, Make cpu,
                   const ResilientOptions& options = {}, Opening opening = Opening::AtStart);
  ~ResilientChecker() override;

  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  BatchResult check(const double* states, std::size_t count, const std::string& group = "",
                    const JointNeighbourhood* around = nullptr) override;
  SceneReport report(const std::string& group = "") override;
  /// Of who answers at present. These three do not wait for a check that runs.
  std::string deviceName() const override;
  std::string deviceWarning() const override;
  DeviceHistory history() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
