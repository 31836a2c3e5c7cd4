#pragma once

#include <cstddef>
#include <cstdint>

#include "gpu/buffer.h"
#include "gpu/fence.h"

namespace gpu_planning_scene::core
{
/// Host memory to which the device copies the front of a buffer. The host can read the copy while the device works on
/// later commands; a plain download would wait for these too. Used on the context's thread.
class Readback
{
 public:
  Readback() = default;
  ~Readback();
  Readback(const Readback&) = delete;
  Readback& operator=(const Readback&) = delete;

  /// Starts a copy of the first `size` bytes of `from`, after all commands that were given before. Throws Error if
  /// OpenGL fails.
  void begin(const Buffer& from, std::size_t size);

  /// Waits for the copy. Its words are valid until the next `begin`. Throws Error if no copy was begun or the device
  /// fails.
  const std::uint32_t* wait();

 private:
  void reserve(std::size_t size);

  std::uint32_t id_ = 0;
  std::size_t size_ = 0;
  const std::uint32_t* words_ = nullptr;
  Fence copied_;
};
}  // namespace gpu_planning_scene::core
