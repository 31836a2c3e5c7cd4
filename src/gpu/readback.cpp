#include "gpu/readback.h"

#include <string>

#include <epoxy/gl.h>

#include "gpu/gl_check.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
Readback::~Readback()
{
  dropFence();
  if (id_)
    glDeleteBuffers(1, &id_);  // also unmaps the buffer
}

void Readback::dropFence()
{
  if (fence_)
    glDeleteSync(static_cast<GLsync>(fence_));
  fence_ = nullptr;
}

void Readback::reserve(std::size_t size)
{
  if (size <= size_)
    return;
  if (id_)
    glDeleteBuffers(1, &id_);
  id_ = 0;
  size_ = 0;
  words_ = nullptr;
  const auto bytes = static_cast<GLsizeiptr>(size + size / 2);
  constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, bytes, nullptr, kAccess | GL_CLIENT_STORAGE_BIT);
  words_ = static_cast<const std::uint32_t*>(glMapNamedBufferRange(id_, 0, bytes, kAccess));
  checkGl("mapping a readback buffer");
  if (!words_)
    throw Error("the GPU failed in mapping a readback buffer of " + std::to_string(bytes) + " bytes");
  size_ = static_cast<std::size_t>(bytes);
}

void Readback::begin(const Buffer& from, std::size_t size)
{
  dropFence();
  reserve(size);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(from.id(), id_, 0, 0, static_cast<GLsizeiptr>(size));
  fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  checkGl("starting a readback");
}

const std::uint32_t* Readback::wait()
{
  if (!fence_)
    throw Error("no readback was begun: call begin() before wait()");
  constexpr GLuint64 kNanoseconds = 1000000000;
  GLenum state = GL_TIMEOUT_EXPIRED;
  while (state == GL_TIMEOUT_EXPIRED)
    state = glClientWaitSync(static_cast<GLsync>(fence_), GL_SYNC_FLUSH_COMMANDS_BIT, kNanoseconds);
  dropFence();
  checkGl("waiting for a readback");
  if (state == GL_WAIT_FAILED)
    throw Error("the GPU failed in waiting for a readback");
  return words_;
}
}  // namespace gpu_planning_scene::core
