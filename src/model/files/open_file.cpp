#include "model/files/open_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
std::ifstream openFile(const std::string& path)
{
  std::error_code unreadable;
  if (std::filesystem::is_directory(path, unreadable))
    throw Error(path + ": this is a folder, not a file");
  errno = 0;
  std::ifstream file(path);
  if (!file)
  {
    const std::string why = std::generic_category().message(errno);
    const std::filesystem::path folder = std::filesystem::current_path(unreadable);
    throw Error(path + ": cannot read the file: " + why +
                (std::filesystem::path(path).is_absolute() ? "" : " (the current folder is " + folder.string() + ")"));
  }
  if (file.peek() == std::ifstream::traits_type::eof())
    throw Error(path + ": the file is empty");
  return file;
}
}  // namespace gpu_planning_scene::core
