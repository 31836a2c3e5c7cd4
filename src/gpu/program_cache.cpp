#include "gpu/program_cache.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <vector>

#include <epoxy/gl.h>
#include <unistd.h>

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{64} << 20U;

struct Entry
{
  GLenum format;
  std::vector<char> binary;
};

/// The beginning of a file. The key and the binary follow.
struct Header
{
  std::array<char, 8> magic = {'G', 'P', 'S', 'P', 'R', 'O', 'G', '1'};
  std::uint64_t format = 0;
  std::uint64_t key_bytes = 0;
  std::uint64_t binary_bytes = 0;
  std::uint64_t checksum = 0;  // of the whole file, with 0 in this field
};
static_assert(sizeof(Header) == 40, "no padding: all of it is written");

/// FNV-1a, 64 bits (Fowler, Noll and Vo).
std::uint64_t hash(const char* data, std::size_t size, std::uint64_t seed = 0xcbf29ce484222325U)
{
  for (std::size_t i = 0; i < size; ++i)
    seed = (seed ^ static_cast<unsigned char>(data[i])) * 0x100000001b3U;
  return seed;
}

/// Empty if the cache is switched off, or if the user has no cache folder and no home folder.
fs::path cacheFolder()
{
  const char* mode = std::getenv("GPU_PLANNING_SCENE_PROGRAM_CACHE");
  if (mode != nullptr && std::strcmp(mode, "off") == 0)
    return {};
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/')
    return fs::path(cache) / "gpu_planning_scene";
  const char* home = std::getenv("HOME");
  return home != nullptr && home[0] == '/' ? fs::path(home) / ".cache" / "gpu_planning_scene" : fs::path();
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

fs::path fileOf(const fs::path& folder, const std::string& key)
{
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash(key.data(), key.size())));
  return folder / (std::string(digits.data()) + ".program");
}

std::uint64_t checksum(Header header, const std::string& key, const std::vector<char>& binary)
{
  header.checksum = 0;
  std::array<char, sizeof(Header)> bytes{};
  std::memcpy(bytes.data(), &header, sizeof(header));
  return hash(binary.data(), binary.size(), hash(key.data(), key.size(), hash(bytes.data(), bytes.size())));
}

/// No value if the file is missing or damaged, or holds another key with the same hash.
std::optional<Entry> readEntry(const fs::path& path, const std::string& key)
{
  std::error_code missing;
  if (fs::file_size(path, missing) > kMaxBytes || missing)
    return {};
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  Header header;
  const Header expected;
  if (bytes.size() < sizeof(header))
    return {};
  std::memcpy(&header, bytes.data(), sizeof(header));
  const std::size_t before_binary = sizeof(header) + key.size();
  if (header.magic != expected.magic || header.key_bytes != key.size() || bytes.size() < before_binary ||
      header.binary_bytes != bytes.size() - before_binary || header.binary_bytes == 0 ||
      key.compare(0, key.size(), &bytes[sizeof(header)], key.size()) != 0)
    return {};
  Entry entry{static_cast<GLenum>(header.format),
              {bytes.begin() + static_cast<std::ptrdiff_t>(before_binary), bytes.end()}};
  if (header.checksum != checksum(header, key, entry.binary))
    return {};
  return entry;
}

/// Writes a temporary file and renames it, so that other processes see the whole file or none.
void writeEntry(const fs::path& path, const std::string& key, const Entry& entry)
{
  Header header;
  header.format = entry.format;
  header.key_bytes = key.size();
  header.binary_bytes = entry.binary.size();
  header.checksum = checksum(header, key, entry.binary);
  std::string temporary = path.string() + ".XXXXXX";
  const int descriptor = mkstemp(temporary.data());
  if (descriptor < 0)
    return;
  close(descriptor);
  std::ofstream file(temporary, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&header), sizeof(header));
  file.write(key.data(), static_cast<std::streamsize>(key.size()));
  file.write(entry.binary.data(), static_cast<std::streamsize>(entry.binary.size()));
  file.close();
  std::error_code failed;
  if (file)
    fs::rename(temporary, path, failed);
  if (!file || failed)
    fs::remove(temporary, failed);
}

/// Removes the files that were used longest ago, until the rest has at most kMaxBytes. Temporary files that a killed
/// process left are removed likewise.
void removeOldest(const fs::path& folder)
{
  struct File
  {
    fs::file_time_type used;
    std::uintmax_t size;
    fs::path path;
  };
  std::vector<File> files;
  std::uintmax_t bytes = 0;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
  {
    std::error_code gone;
    const File file{entry->last_write_time(gone), entry->file_size(gone), entry->path()};
    if (gone)
      continue;
    bytes += file.size;
    files.push_back(file);
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
  for (auto file = files.begin(); file != files.end() && bytes > kMaxBytes; ++file)
  {
    fs::remove(file->path, failed);
    bytes -= file->size;
  }
}

void clearErrors()
{
  for (int i = 0; i < 8 && glGetError() != GL_NO_ERROR; ++i)
  {
  }
}
}  // namespace

std::uint32_t loadCachedProgram(const std::string& source)
{
  const fs::path folder = cacheFolder();
  const std::vector<GLint> formats = binaryFormats();
  if (folder.empty() || formats.empty())
    return 0;
  const std::string key = keyOf(source);
  const fs::path path = fileOf(folder, key);
  const std::optional<Entry> entry = readEntry(path, key);
  if (!entry || std::find(formats.begin(), formats.end(), static_cast<GLint>(entry->format)) == formats.end())
    return 0;
  const GLuint program = glCreateProgram();
  glProgramBinary(program, entry->format, entry->binary.data(), static_cast<GLsizei>(entry->binary.size()));
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  clearErrors();
  if (!good)
  {
    glDeleteProgram(program);
    return 0;
  }
  std::error_code ignored;
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
  return program;
}

void cacheProgram(std::uint32_t program, const std::string& source)
{
  const fs::path folder = cacheFolder();
  if (folder.empty() || binaryFormats().empty())
    return;
  GLint size = 0;
  glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
  Entry entry{0, std::vector<char>(static_cast<std::size_t>(std::max(size, 0)))};
  if (size > 0)
    glGetProgramBinary(program, size, &size, &entry.format, entry.binary.data());
  const bool failed = glGetError() != GL_NO_ERROR;
  clearErrors();
  if (failed || size <= 0)
    return;
  entry.binary.resize(static_cast<std::size_t>(size));
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const std::string key = keyOf(source);
  writeEntry(fileOf(folder, key), key, entry);
  removeOldest(folder);
}
}  // namespace gpu_planning_scene::core
