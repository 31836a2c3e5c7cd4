#include "support/shader_folder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace gpu_planning_scene::core
{
ShaderFolder::ShaderFolder() : ShaderFolder(GPS_SOURCE_DIR "/shaders") {}

ShaderFolder::ShaderFolder(const std::string& original)
{
  std::string name = (std::filesystem::temp_directory_path() / "shadersXXXXXX").string();
  if (!mkdtemp(name.data()))
    throw std::runtime_error("no temporary folder");
  path_ = name;
  std::filesystem::copy(original, path_, std::filesystem::copy_options::recursive);
}

ShaderFolder::~ShaderFolder()
{
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void ShaderFolder::define(const std::string& name, const std::string& value) const
{
  std::ifstream in(path_ + "/shader_constants.h");
  std::ostringstream text;
  bool found = false;
  for (std::string line; std::getline(in, line);)
  {
    const bool here = line.rfind("#define " + name + " ", 0) == 0;
    found = found || here;
    text << (here ? "#define " + name + " " + value : line) << '\n';
  }
  if (!found)
    throw std::runtime_error("shader_constants.h has no " + name);
  write("shader_constants.h", text.str());
}

void ShaderFolder::replace(const std::string& name, const std::string& text, const std::string& by) const
{
  std::ifstream in(path_ + "/" + name);
  std::ostringstream read;
  read << in.rdbuf();
  std::string changed = read.str();
  const std::size_t place = changed.find(text);
  if (place == std::string::npos || changed.find(text, place + 1) != std::string::npos)
    throw std::runtime_error(name + " does not have '" + text + "' exactly once");
  write(name, changed.replace(place, text.size(), by));
}

void ShaderFolder::write(const std::string& name, const std::string& text) const
{
  std::ofstream(path_ + "/" + name) << text;
}
}  // namespace gpu_planning_scene::core
