#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The devices that a user has selected: the parts of "A+B", or all hardware devices for "all" ("auto" if there is
/// none). Throws Error for "all" if the EGL or OpenGL library is missing, and if a part is empty.
std::vector<std::string> devicesOf(const std::string& selection);

/// Several devices as one checker. A large batch is cut into shares, and each share goes to the next free device. The
/// order of the states is kept. If a device is lost, the others check its shares and all later batches; deviceWarning
/// then names it. A device also counts as lost if it holds another scene than the others. DeviceLost is thrown only if
/// no device is left.
class DeviceGroup : public StateChecker
{
 public:
  using Open = std::function<std::unique_ptr<StateChecker>(std::shared_ptr<const PlanningScene> scene,
                                                           const std::string& device)>;

  /// Opens all devices. Throws the Error of the first that cannot be opened.
  DeviceGroup(const std::shared_ptr<const PlanningScene>& scene, const std::vector<std::string>& devices,
              const Open& open);

  /// Throws Error and keeps the old scene on all devices if one of them cannot take the new scene.
  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  BatchResult check(const double* states, std::size_t count, const std::string& group = "",
                    const JointNeighbourhood* around = nullptr) override;
  /// Pairs as one device reports them; SceneReport::decided is summed over the devices.
  SceneReport report(const std::string& group = "") override;
  std::string deviceName() const override;
  std::string deviceWarning() const override;

 private:
  struct Batch;
  using Errors = std::vector<std::exception_ptr>;  // of the first devices; null: none
  void requireDevice() const;
  Errors onEachDevice(std::size_t count, const std::function<void(StateChecker&)>& action);
  std::exception_ptr dropLost(const Errors& errors);
  void restoreScene();
  void checkShares(StateChecker& device, Batch& batch) const;

  mutable std::mutex mutex_;
  std::shared_ptr<const PlanningScene> scene_;
  std::vector<std::unique_ptr<StateChecker>> devices_;
  std::string lost_;  // one line; empty: none
};
}  // namespace gpu_planning_scene::core
