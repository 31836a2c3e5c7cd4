#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// The folder that holds the shaders: $GPU_PLANNING_SCENE_SHADERS if set, else where they were installed, else the
/// source tree. Throws Error if none of them has any.
std::string shaderFolder();

/// Reads a shader and the files that it includes (#include "NAME", from the same folder, each once). Throws Error that
/// names a missing file.
std::string readShader(const std::string& folder, const std::string& name);

/// Workgroups of GROUP_SIZE that have at least `lanes` lanes.
std::size_t groupsFor(std::size_t lanes);

/// A compute program. Move-only; used on the context's thread.
class Program
{
 public:
  /// Compiles `name` of `folder`, or takes it from the program cache; `definitions` are lines that go before its text
  /// ("#define X 1\n"). Throws Error with the compiler's log.
  Program(const std::string& folder, const std::string& name, const std::string& definitions = "");
  /// The same from a text of the program's own making, which may include files of `folder`. `name` is for messages.
  static Program fromText(const std::string& folder, const std::string& name, const std::string& text);
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&&) = delete;

  /// Uniforms have explicit locations in the shaders.
  void set(int location, std::uint32_t value) const;
  void setFloat(int location, float value) const;

  /// Runs `groups` workgroups (at most the 65535 that OpenGL grants in x; more are spread over y), after all that was
  /// dispatched before. Zero groups do nothing.
  void dispatch(std::size_t groups) const;
  /// The same with the group counts that lie in `arguments` at `offset` (three uints).
  void dispatchIndirect(const Buffer& arguments, std::size_t offset) const;

 private:
  struct Source
  {
    std::string name;
    std::string text;  // complete
  };
  explicit Program(const Source& source);

  std::uint32_t id_ = 0;
};
}  // namespace gpu_planning_scene::core
