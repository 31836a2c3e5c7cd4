#pragma once

#include <memory>
#include <string>

#include "gpu_planning_scene/batch_checker_options.h"

namespace gpu_planning_scene::core
{
class DeviceParts;
class LaneScene;
struct CollisionProblem;

/// The robot and the scene that a device checks. Immutable.
struct DeviceTask
{
  std::shared_ptr<const RobotModel> robot;
  std::shared_ptr<const CollisionProblem> scene;  ///< the problem of all pairs
  std::shared_ptr<const CollisionProblem> group;  ///< the problem of a group: the same shapes, fewer pairs
  /// Of `group`, made with lanes::kDeviceRounding. Null: no proofs.
  std::shared_ptr<const LaneScene> proofs;
};

/// A device that checks parts of batches. Used on one thread.
class BatchDevice
{
 public:
  virtual ~BatchDevice() = default;

  /// Makes the device ready for the task. Throws DeviceLost, or Error if the device cannot hold the scene; the object
  /// is unusable then.
  virtual void prepare(const DeviceTask& task) = 0;

  /// Takes parts until there is none, checks them with the task of the last prepare(), and answers them. Throws
  /// DeviceLost.
  virtual void check(DeviceParts& parts) = 0;

  virtual std::string name() const = 0;
  /// Whether the device runs on the cores of the CPU.
  virtual bool isSoftware() const = 0;
  /// See StateChecker::deviceWarning.
  virtual std::string fault() const = 0;
};

/// Opens the device that options.device names. Throws Error if it cannot be used.
std::unique_ptr<BatchDevice> openGpuDevice(const BatchCheckerOptions& options);
}  // namespace gpu_planning_scene::core
