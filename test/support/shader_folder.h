#pragma once

#include <string>
#include <utility>
#include <vector>

namespace gpu_planning_scene::core
{
/// A temporary copy of shaders that a test or benchmark may change; removed at the end.
class ShaderFolder
{
 public:
  ShaderFolder();  ///< of the source tree's
  explicit ShaderFolder(const std::string& original);
  ~ShaderFolder();
  ShaderFolder(const ShaderFolder&) = delete;
  ShaderFolder& operator=(const ShaderFolder&) = delete;

  const std::string& path() const { return path_; }

  /// Gives a constant of shader_constants.h another value; throws std::runtime_error if it is not there.
  void define(const std::string& name, const std::string& value) const;
  /// Replaces the one place where a file has `text`; throws std::runtime_error if there is not exactly one.
  void replace(const std::string& name, const std::string& text, const std::string& by) const;
  void write(const std::string& name, const std::string& text) const;

 private:
  std::string path_;
};
}  // namespace gpu_planning_scene::core
