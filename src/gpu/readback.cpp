#include "gpu/readback.h"

#include <string>

#include <epoxy/gl.h>

#include "gpu/gl_check.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
Readback::~Readback()
{
  if (id_)
    glDeleteBuffers(1, &id_);  // also unmaps the buffer
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
    throw DeviceLost("the GPU failed in mapping a readback buffer of " + std::to_string(bytes) + " bytes");
  size_ = static_cast<std::size_t>(bytes);
}

void Readback::begin(const Buffer& from, std::size_t size)
{
  copied_.drop();
  reserve(size);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(from.id(), id_, 0, 0, static_cast<GLsizeiptr>(size));
  copied_.place();
  glFlush();
  checkGl("starting a readback");
}

const std::uint32_t* Readback::wait()
{
  if (!copied_.isPlaced())
    throw Error("no readback was begun: call begin() before wait()");
  copied_.wait("a readback");
  return words_;
}
}  // namespace gpu_planning_scene::core
