#pragma once

namespace gpu_planning_scene::core
{
/// A mark in the commands of the current context, for which the host can wait. Used on the context's thread.
class Fence
{
 public:
  Fence() = default;
  ~Fence() { drop(); }
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;

  /// Marks the end of all commands that were given so far. An earlier mark is forgotten.
  void place();
  bool isPlaced() const { return sync_ != nullptr; }

  /// Waits until the device has executed all commands before the mark, then forgets the mark. Throws DeviceLost if the
  /// device fails or its context is lost meanwhile. A device that hangs without an error is the business of
  /// DeviceWorker. `what`: the operation, for the message.
  void wait(const char* what);
  void drop();

 private:
  void* sync_ = nullptr;  // GLsync
};
}  // namespace gpu_planning_scene::core
