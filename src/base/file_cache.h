#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// The folder for files that save time at the next start: $XDG_CACHE_HOME/gpu_planning_scene, else
/// ~/.cache/gpu_planning_scene. Empty if the environment variable `switch_name` is "off", or if the user has no cache
/// folder and no home folder.
std::filesystem::path userCacheFolder(const char* switch_name);

/// A folder of files that are found by a key. A file is used only if its magic, its whole key and its checksum match.
/// Files are replaced as a whole, so several threads and processes may use the folder at the same time. A failure of
/// the file system is no error: nothing is found or stored then. Thread-safe.
class FileCache
{
 public:
  /// Identifies the kind of the files and the version of their layout.
  using Magic = std::array<char, 8>;

  /// `folder`: made when the first file is stored; empty: nothing is found or stored. `ending`: of the file names.
  /// `most_bytes`: see removeOldest.
  FileCache(std::filesystem::path folder, const Magic& magic, std::string ending, std::uintmax_t most_bytes);

  bool isOff() const { return folder_.empty(); }

  /// The content that was stored with this key. Marks the file as used.
  std::optional<std::vector<char>> load(const std::string& key) const;

  void store(const std::string& key, const std::vector<char>& content) const;

  /// Removes the files of the folder that were used longest ago, until the rest has at most `most_bytes`. Temporary
  /// files that a killed process left are removed likewise.
  void removeOldest() const;

 private:
  std::filesystem::path fileOf(const std::string& key) const;

  std::filesystem::path folder_;
  Magic magic_;
  std::string ending_;
  std::uintmax_t most_bytes_;
};
}  // namespace gpu_planning_scene::core
