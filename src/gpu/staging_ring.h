#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "gpu/fence.h"

namespace gpu_planning_scene::core
{
/// Uploads data to buffers of the context that is current on this thread. The data goes through host memory that stays
/// mapped, and a command of the device copies it to the buffer. So an upload takes its place among dispatches, clears
/// and copies. The buffers themselves need not be writable for the host: NVIDIA's driver moves a buffer with
/// GL_DYNAMIC_STORAGE_BIT to host memory after some uploads, and later uploads then overtake clears and copies that
/// were given before (docs/gpu.md).
class StagingRing
{
 public:
  StagingRing() = default;
  ~StagingRing() { release(); }
  StagingRing(const StagingRing&) = delete;
  StagingRing& operator=(const StagingRing&) = delete;

  /// The ring of this thread. It allocates memory when it is first used.
  static StagingRing& ofThisThread();

  /// Copies `size` bytes to `offset` of a buffer, after all commands that were given before. The data may change as
  /// soon as the function returns. It waits only if the device has not yet executed the last kPieces uploads of the
  /// size of a piece. Throws OutOfDeviceMemory or DeviceLost.
  void upload(std::uint32_t buffer, std::size_t offset, const void* data, std::size_t size);

  /// The same for data that `fill` writes: `size` bytes, at most kLargestPieceBytes. It must not read them: this memory
  /// may be slow to read.
  void upload(std::uint32_t buffer, std::size_t offset, std::size_t size, const std::function<void(void* to)>& fill);

  /// Frees the memory. Must be called before the context is destroyed.
  void release();

  static constexpr std::size_t kPieces = 4;
  static constexpr std::size_t kFirstPieceBytes = std::size_t{1} << 20U;
  /// A larger upload is split. The states of the largest part for a robot of 50 joints fill two pieces, so that the
  /// states of two parts fit into the ring.
  static constexpr std::size_t kLargestPieceBytes = std::size_t{1} << 25U;
  std::size_t pieceBytes() const { return piece_bytes_; }

 private:
  std::size_t place(std::size_t size);
  void grow(std::size_t size);

  std::uint32_t id_ = 0;
  char* memory_ = nullptr;
  std::size_t piece_bytes_ = 0;
  std::size_t piece_ = 0;              // the piece that is being filled
  std::size_t used_ = 0;               // bytes of it
  std::array<Fence, kPieces> copied_;  // placed when a piece was full: its copies
};
}  // namespace gpu_planning_scene::core
