#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// The folder of the shaders: $GPU_PLANNING_SCENE_SHADERS if set (not checked), else the installed folder, else the
/// folder in the source tree. Throws Error if neither of these two holds the shaders.
std::string shaderFolder();

/// Reads a shader and the files that it includes (#include "NAME", relative to `folder`, each once). Throws Error with
/// the name of a missing file.
std::string readShader(const std::string& folder, const std::string& name);

/// The number of work groups of GROUP_SIZE that hold at least `invocations` invocations.
std::size_t groupsFor(std::size_t invocations);

/// A compute program. Move-only; used on the context's thread. Its label in OpenGL, for tools that show or time its
/// dispatches, is the name of its shader with the names and values of its definitions.
class Program
{
 public:
  /// Compiles the shader `name` of `folder`, or loads it from the program cache. `definitions` are lines that precede
  /// its text ("#define X 1\n"). Throws Error with the compiler's log.
  Program(const std::string& folder, const std::string& name, const std::string& definitions = "");
  /// Compiles a generated `text`, which may include files of `folder`. `name` is for messages.
  static Program fromText(const std::string& folder, const std::string& name, const std::string& text);
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&&) = delete;

  /// The size of the compiled program in bytes, with what the driver keeps beside its instructions. 0: the driver does
  /// not tell.
  std::size_t binaryBytes() const;

  /// Sets a uniform. The shaders give its location explicitly (LOCATION_* in shader_constants.h).
  void set(int location, std::uint32_t value) const;
  void setFloat(int location, float value) const;

  /// Runs `groups` work groups after all earlier dispatches. OpenGL grants MAX_GROUPS of them along x; more are spread
  /// over y. Zero groups do nothing. Throws Error if OpenGL cannot run that many.
  void dispatch(std::size_t groups) const;
  /// The same with the numbers of work groups that lie in `arguments` at `offset` (three uints).
  void dispatchIndirect(const Buffer& arguments, std::size_t offset) const;

 private:
  struct Source
  {
    std::string name;
    std::string text;   // complete
    std::string label;  // of the program in OpenGL
  };
  explicit Program(const Source& source);

  std::uint32_t id_ = 0;
};
}  // namespace gpu_planning_scene::core
