#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace gpu_planning_scene::core
{
/// A block of GPU memory, which only commands of the device read and write (see StagingRing). Move-only; used on the
/// context's thread. All sizes are in bytes. Throws Error if OpenGL fails (out of memory, out of range), and for more
/// than maxBytes().
class Buffer
{
 public:
  Buffer() = default;
  explicit Buffer(std::size_t size);
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  std::size_t size() const { return size_; }
  std::uint32_t id() const { return id_; }
  /// The most bytes that the device lets a shader bind as a storage buffer. Beyond it, OpenGL may drop what shaders
  /// write.
  static std::size_t maxBytes();

  /// Grows to at least `size` bytes and keeps the contents. It grows by at least half of its size, so that it seldom
  /// grows, unless this would exceed `max_bytes` or maxBytes().
  void reserve(std::size_t size, std::size_t max_bytes = std::numeric_limits<std::size_t>::max());
  void write(const void* data, std::size_t size, std::size_t offset = 0);
  /// `fill` writes the `size` bytes, at most StagingRing::kLargestPieceBytes.
  void write(std::size_t size, std::size_t offset, const std::function<void(void* to)>& fill);
  void read(void* data, std::size_t size, std::size_t offset = 0) const;
  void clear();                                                              ///< fills the buffer with zeros
  void clear(std::size_t offset, std::size_t size, std::uint32_t word = 0);  ///< fills a part with copies of a word
  void copyFrom(const Buffer& other, std::size_t size);                      ///< copies the first `size` bytes

  void bindStorage(std::uint32_t binding) const;
  /// Binds a part of the buffer. `offset` is a multiple of kStorageAlignment.
  void bindStorage(std::uint32_t binding, std::size_t offset, std::size_t size) const;
  static constexpr std::size_t kStorageAlignment = 256;  // the largest alignment that OpenGL lets a device require

  template <class T>
  void write(const std::vector<T>& data)
  {
    write(data.data(), data.size() * sizeof(T));
  }

 private:
  std::uint32_t id_ = 0;
  std::size_t size_ = 0;
};

/// A buffer that shaders read through a buffer texture of 16-byte texels (RGBA32UI). On llvmpipe this costs a quarter
/// of a read from a storage buffer. The texels are integers, so that bit patterns survive on devices that flush
/// denormals.
class TexelBuffer
{
 public:
  TexelBuffer() = default;
  ~TexelBuffer();
  TexelBuffer(const TexelBuffer&) = delete;
  TexelBuffer& operator=(const TexelBuffer&) = delete;

  /// Grows to at least `size` bytes and keeps the contents. Throws Error beyond the device's limit; the buffer is then
  /// unchanged.
  void reserve(std::size_t size);
  Buffer& buffer() { return buffer_; }
  const Buffer& buffer() const { return buffer_; }
  static std::size_t maxBytes();  ///< the device's limit for a buffer that shaders write and fetch
  static constexpr std::size_t kTexelBytes = 16;
  void bindTexture(std::uint32_t unit) const;

 private:
  Buffer buffer_;
  std::uint32_t texture_ = 0;
  bool is_texture_current_ = false;  // whether the texture shows buffer_
};
}  // namespace gpu_planning_scene::core
