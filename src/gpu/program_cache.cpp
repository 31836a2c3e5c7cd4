#include "gpu/program_cache.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include <epoxy/gl.h>

#include "base/file_cache.h"

namespace gpu_planning_scene::core
{
namespace
{
FileCache programs()
{
  constexpr FileCache::Magic kMagic = {'G', 'P', 'S', 'P', 'R', 'O', 'G', '2'};
  constexpr std::uintmax_t kMaxBytes = std::uintmax_t{64} << 20U;
  return FileCache(userCacheFolder("GPU_PLANNING_SCENE_PROGRAM_CACHE"), kMagic, ".program", kMaxBytes);
}

std::vector<GLint> binaryFormats()
{
  GLint count = 0;
  glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
  std::vector<GLint> formats(static_cast<std::size_t>(std::max(count, 0)));
  if (!formats.empty())
    glGetIntegerv(GL_PROGRAM_BINARY_FORMATS, formats.data());
  return formats;
}

/// The key of a program: all that its binary depends on.
std::string keyOf(const std::string& source)
{
  std::string key;
  for (const GLenum name : {GL_VENDOR, GL_RENDERER, GL_VERSION})
  {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    key += std::string(text != nullptr ? text : "") + '\n';
  }
  return key + source;
}

void clearErrors()
{
  for (int i = 0; i < 8 && glGetError() != GL_NO_ERROR; ++i)
  {
  }
}
}  // namespace

/// A file holds the format of the binary, then the binary.
std::uint32_t loadCachedProgram(const std::string& source)
{
  const FileCache cache = programs();
  const std::vector<GLint> formats = binaryFormats();
  if (cache.isOff() || formats.empty())
    return 0;
  const std::optional<std::vector<char>> content = cache.load(keyOf(source));
  GLenum format = 0;
  if (!content || content->size() <= sizeof(format))
    return 0;
  std::memcpy(&format, content->data(), sizeof(format));
  if (std::find(formats.begin(), formats.end(), static_cast<GLint>(format)) == formats.end())
    return 0;
  const GLuint program = glCreateProgram();
  glProgramBinary(program, format, content->data() + sizeof(format),
                  static_cast<GLsizei>(content->size() - sizeof(format)));
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  clearErrors();
  if (good)
    return program;
  glDeleteProgram(program);
  return 0;
}

void cacheProgram(std::uint32_t program, const std::string& source)
{
  const FileCache cache = programs();
  if (cache.isOff() || binaryFormats().empty())
    return;
  GLint size = 0;
  glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
  GLenum format = 0;
  std::vector<char> content(sizeof(format) + static_cast<std::size_t>(std::max(size, 0)));
  if (size > 0)
    glGetProgramBinary(program, size, &size, &format, content.data() + sizeof(format));
  const bool failed = glGetError() != GL_NO_ERROR;
  clearErrors();
  if (failed || size <= 0)
    return;
  std::memcpy(content.data(), &format, sizeof(format));
  content.resize(sizeof(format) + static_cast<std::size_t>(size));
  cache.store(keyOf(source), content);
  cache.removeOldest();
}
}  // namespace gpu_planning_scene::core
