#include "gpu/buffer.h"

#include <algorithm>
#include <string>
#include <utility>

#include <epoxy/gl.h>

#include "gpu/gl_check.h"
#include "gpu/staging_ring.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Orders the next transfer after all earlier writes of shaders.
void waitForShaders()
{
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// OpenGL reports a limit beyond the range of GLint as the largest GLint.
std::size_t limit(GLenum name)
{
  GLint value = 0;
  glGetIntegerv(name, &value);
  return static_cast<std::size_t>(std::max(0, value));
}

void requireWithin(std::size_t size, std::size_t max_bytes)
{
  if (size > max_bytes)
    throw Error("the scene needs a buffer of " + std::to_string(size) +
                " bytes, but a shader of this device can use at " + "most " + std::to_string(max_bytes) +
                "; use fewer triangles, a smaller batch or the device 'cpu'");
}
}  // namespace

Buffer::Buffer(std::size_t size) : size_(std::max<std::size_t>(size, 16))
{
  requireWithin(size, maxBytes());
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(size_), nullptr, 0);
  checkGl(("allocating " + std::to_string(size_) + " bytes").c_str());
}

Buffer::~Buffer()
{
  if (id_)
    glDeleteBuffers(1, &id_);
}

Buffer::Buffer(Buffer&& other) noexcept : id_(std::exchange(other.id_, 0)), size_(std::exchange(other.size_, 0)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept
{
  std::swap(id_, other.id_);
  std::swap(size_, other.size_);
  return *this;
}

std::size_t Buffer::maxBytes()
{
  return limit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
}

void Buffer::reserve(std::size_t size, std::size_t max_bytes)
{
  if (size <= size_)
    return;
  Buffer larger(std::max(size, std::min({max_bytes, maxBytes(), size_ + size_ / 2})));
  if (size_)
    larger.copyFrom(*this, size_);
  *this = std::move(larger);
}

void Buffer::write(const void* data, std::size_t size, std::size_t offset)
{
  if (size == 0)
    return;
  waitForShaders();
  StagingRing::ofThisThread().upload(id_, offset, data, size);
  checkGl("an upload");
}

void Buffer::write(std::size_t size, std::size_t offset, const std::function<void(void* to)>& fill)
{
  if (size == 0)
    return;
  waitForShaders();
  StagingRing::ofThisThread().upload(id_, offset, size, fill);
  checkGl("an upload");
}

void Buffer::read(void* data, std::size_t size, std::size_t offset) const
{
  if (size == 0)
    return;
  waitForShaders();
  glGetNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(size), data);
  checkGl("a download");
}

void Buffer::clear()
{
  clear(0, size_);
}

void Buffer::clear(std::size_t offset, std::size_t size, std::uint32_t word)
{
  waitForShaders();
  glClearNamedBufferSubData(id_, GL_R32UI, static_cast<GLintptr>(offset),
                            static_cast<GLsizeiptr>(size & ~std::size_t{3}), GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
  checkGl("clearing a buffer");
}

void Buffer::copyFrom(const Buffer& other, std::size_t size)
{
  waitForShaders();
  glCopyNamedBufferSubData(other.id_, id_, 0, 0, static_cast<GLsizeiptr>(size));
  checkGl("copying a buffer");
}

void Buffer::bindStorage(std::uint32_t binding) const
{
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}

void Buffer::bindStorage(std::uint32_t binding, std::size_t offset, std::size_t size) const
{
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, id_, static_cast<GLintptr>(offset),
                    static_cast<GLsizeiptr>(size));
}

TexelBuffer::~TexelBuffer()
{
  if (texture_)
    glDeleteTextures(1, &texture_);
}

std::size_t TexelBuffer::maxBytes()
{
  return std::min(limit(GL_MAX_TEXTURE_BUFFER_SIZE) * kTexelBytes, Buffer::maxBytes());
}

void TexelBuffer::reserve(std::size_t size)
{
  if (size <= buffer_.size() && is_texture_current_)
    return;
  const std::size_t max_bytes = maxBytes();
  requireWithin(size, max_bytes);
  is_texture_current_ = false;  // if something throws, the next call tries again
  buffer_.reserve(size, max_bytes);
  if (!texture_)
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &texture_);
  glTextureBuffer(texture_, GL_RGBA32UI, buffer_.id());
  checkGl("making a buffer texture");
  is_texture_current_ = true;
}

void TexelBuffer::bindTexture(std::uint32_t unit) const
{
  glBindTextureUnit(unit, texture_);
}
}  // namespace gpu_planning_scene::core
