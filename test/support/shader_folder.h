#pragma once

#include <string>
#include <utility>
#include <vector>

namespace gpu_planning_scene::core
{
/// A temporary copy of shaders that a test or benchmark may change. The destructor removes it.
class ShaderFolder
{
 public:
  ShaderFolder();  ///< copies the shaders of the source tree
  explicit ShaderFolder(const std::string& original);
  ~ShaderFolder();
  ShaderFolder(const ShaderFolder&) = delete;
  ShaderFolder& operator=(const ShaderFolder&) = delete;

  const std::string& path() const { return path_; }

  /// Changes the value of a constant of shader_constants.h. Throws std::runtime_error if the constant is missing.
  void define(const std::string& name, const std::string& value) const;
  /// Replaces `text` in a file by `by`. Throws std::runtime_error unless the file has `text` exactly once.
  void replace(const std::string& name, const std::string& text, const std::string& by) const;
  void write(const std::string& name, const std::string& text) const;

 private:
  std::string path_;
};
}  // namespace gpu_planning_scene::core
