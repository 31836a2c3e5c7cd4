#pragma once

#include <cstddef>
#include <cstdint>

#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// Host memory that the device copies a buffer's front to. What it was asked for can be read without waiting for what
/// the device was given to do later, as a plain download would. Used on the context's thread.
class Readback
{
 public:
  Readback() = default;
  ~Readback();
  Readback(const Readback&) = delete;
  Readback& operator=(const Readback&) = delete;

  /// Has the first `size` bytes copied, once all that was begun before is done. Throws Error where OpenGL fails.
  void begin(const Buffer& from, std::size_t size);

  /// Waits for the copy; the words hold until the next `begin`. Throws Error if there is none or the device fails.
  const std::uint32_t* wait();

 private:
  void reserve(std::size_t size);
  void dropFence();

  std::uint32_t id_ = 0;
  std::size_t size_ = 0;
  const std::uint32_t* words_ = nullptr;
  void* fence_ = nullptr;  // GLsync
};
}  // namespace gpu_planning_scene::core
