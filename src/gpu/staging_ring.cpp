#include "gpu/staging_ring.h"

#include <algorithm>
#include <cstring>
#include <string>

#include <epoxy/gl.h>

#include "gpu/gl_check.h"

// A ring of pieces. When a piece is full, a fence marks its copies, and the next piece is filled after its own fence
// has been reached. The ring grows with the uploads, so that the states of a part fit into a piece, and does not
// shrink.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kAlignment = 64;  // bytes; of a line of a processor's cache
}  // namespace

StagingRing& StagingRing::ofThisThread()
{
  thread_local StagingRing ring;  // as a context is current on one thread
  return ring;
}

void StagingRing::upload(std::uint32_t buffer, std::size_t offset, const void* data, std::size_t size)
{
  const char* from = static_cast<const char*>(data);
  for (std::size_t done = 0; done < size;)
  {
    const std::size_t bytes = std::min(size - done, kLargestPieceBytes);
    upload(buffer, offset + done, bytes, [&](void* to) { std::memcpy(to, from + done, bytes); });
    done += bytes;
  }
}

void StagingRing::upload(std::uint32_t buffer, std::size_t offset, std::size_t size,
                         const std::function<void(void* to)>& fill)
{
  const std::size_t at = place(size);
  fill(memory_ + at);
  glCopyNamedBufferSubData(id_, buffer, static_cast<GLintptr>(at), static_cast<GLintptr>(offset),
                           static_cast<GLsizeiptr>(size));
}

/// Returns the offset of `size` free bytes, which the next copy reads.
std::size_t StagingRing::place(std::size_t size)
{
  if (size > piece_bytes_)
    grow(size);
  if (used_ + size > piece_bytes_)
  {
    const std::size_t next = (piece_ + 1) % kPieces;
    copied_[piece_].place();
    if (copied_[next].isPlaced())
      copied_[next].wait("an upload");
    piece_ = next;
    used_ = 0;
  }
  const std::size_t at = piece_ * piece_bytes_ + used_;
  used_ = std::min(piece_bytes_, (used_ + size + kAlignment - 1) / kAlignment * kAlignment);
  return at;
}

/// Replaces the memory by larger memory. OpenGL keeps the old memory until the device has executed its copies.
void StagingRing::grow(std::size_t size)
{
  std::size_t piece_bytes = kFirstPieceBytes;
  while (piece_bytes < size)
    piece_bytes *= 2;
  release();
  const auto bytes = static_cast<GLsizeiptr>(kPieces * piece_bytes);
  constexpr GLbitfield kAccess = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, bytes, nullptr, kAccess | GL_CLIENT_STORAGE_BIT);
  memory_ = static_cast<char*>(glMapNamedBufferRange(id_, 0, bytes, kAccess));
  checkGl("mapping a buffer for uploads");
  if (!memory_)
    throw DeviceLost("the GPU failed in mapping a buffer of " + std::to_string(bytes) + " bytes for uploads");
  piece_bytes_ = piece_bytes;
}

void StagingRing::release()
{
  for (Fence& fence : copied_)
    fence.drop();
  if (id_)
    glDeleteBuffers(1, &id_);  // also unmaps the buffer
  id_ = 0;
  memory_ = nullptr;
  piece_bytes_ = piece_ = used_ = 0;
}
}  // namespace gpu_planning_scene::core
