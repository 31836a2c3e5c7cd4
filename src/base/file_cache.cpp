#include "base/file_cache.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

/// The beginning of a file. The key and the content follow.
struct Header
{
  FileCache::Magic magic{};
  std::uint64_t key_bytes = 0;
  std::uint64_t content_bytes = 0;
  std::uint64_t checksum = 0;  // of the whole file, with 0 in this field
};
static_assert(sizeof(Header) == 32, "no padding: all of it is written");

/// FNV-1a, 64 bits (Fowler, Noll and Vo).
std::uint64_t hash(const char* data, std::size_t size, std::uint64_t seed = 0xcbf29ce484222325U)
{
  for (std::size_t i = 0; i < size; ++i)
    seed = (seed ^ static_cast<unsigned char>(data[i])) * 0x100000001b3U;
  return seed;
}

std::uint64_t checksum(Header header, const std::string& key, const std::vector<char>& content)
{
  header.checksum = 0;
  std::array<char, sizeof(Header)> bytes{};
  std::memcpy(bytes.data(), &header, sizeof(header));
  return hash(content.data(), content.size(), hash(key.data(), key.size(), hash(bytes.data(), bytes.size())));
}
}  // namespace

fs::path userCacheFolder(const char* switch_name)
{
  const char* mode = std::getenv(switch_name);
  if (mode != nullptr && std::strcmp(mode, "off") == 0)
    return {};
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/')
    return fs::path(cache) / "gpu_planning_scene";
  const char* home = std::getenv("HOME");
  return home != nullptr && home[0] == '/' ? fs::path(home) / ".cache" / "gpu_planning_scene" : fs::path();
}

FileCache::FileCache(fs::path folder, const Magic& magic, std::string ending, std::uintmax_t most_bytes)
  : folder_(std::move(folder)), magic_(magic), ending_(std::move(ending)), most_bytes_(most_bytes)
{
}

fs::path FileCache::fileOf(const std::string& key) const
{
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash(key.data(), key.size())));
  return folder_ / (digits.data() + ending_);
}

std::optional<std::vector<char>> FileCache::load(const std::string& key) const
{
  if (isOff())
    return {};
  const fs::path path = fileOf(key);
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(path, failed);
  if (failed || size < sizeof(Header) + key.size() || size > most_bytes_)
    return {};
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes(static_cast<std::size_t>(size));
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    return {};
  Header header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  const std::size_t before_content = sizeof(header) + key.size();
  if (header.magic != magic_ || header.key_bytes != key.size() ||
      header.content_bytes != bytes.size() - before_content ||
      key.compare(0, key.size(), bytes.data() + sizeof(header), key.size()) != 0)
    return {};
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(before_content));
  if (header.checksum != checksum(header, key, bytes))
    return {};
  fs::last_write_time(path, fs::file_time_type::clock::now(), failed);
  return bytes;
}

/// Writes a temporary file and renames it, so that other processes see the whole file or none.
void FileCache::store(const std::string& key, const std::vector<char>& content) const
{
  if (isOff())
    return;
  std::error_code failed;
  fs::create_directories(folder_, failed);
  const fs::path path = fileOf(key);
  Header header{magic_, key.size(), content.size(), 0};
  header.checksum = checksum(header, key, content);
  std::string temporary = path.string() + ".XXXXXX";
  const int descriptor = mkstemp(temporary.data());
  if (descriptor < 0)
    return;
  close(descriptor);
  std::ofstream file(temporary, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&header), sizeof(header));
  file.write(key.data(), static_cast<std::streamsize>(key.size()));
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  failed.clear();
  if (file)
    fs::rename(temporary, path, failed);
  if (!file || failed)
    fs::remove(temporary, failed);
}

void FileCache::removeOldest() const
{
  struct File
  {
    fs::file_time_type used;
    std::uintmax_t size;
    fs::path path;
  };
  if (isOff())
    return;
  std::vector<File> files;
  std::uintmax_t bytes = 0;
  std::error_code failed;
  for (fs::directory_iterator entry(folder_, failed), end; !failed && entry != end; entry.increment(failed))
  {
    std::error_code gone;
    std::error_code no_file;  // of a folder: another cache
    const File file{entry->last_write_time(gone), entry->file_size(no_file), entry->path()};
    if (gone || no_file)
      continue;
    bytes += file.size;
    files.push_back(file);
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
  for (auto file = files.begin(); file != files.end() && bytes > most_bytes_; ++file)
  {
    fs::remove(file->path, failed);
    bytes -= file->size;
  }
}
}  // namespace gpu_planning_scene::core
