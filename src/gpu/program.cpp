#include "gpu/program.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include <dlfcn.h>
#include <epoxy/gl.h>

#include "gpu/gl_check.h"
#include "gpu/program_cache.h"
#include "gpu_planning_scene/error.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMaxGroups = MAX_GROUPS;

/// Orders the next dispatch after earlier writes that it may read. Transfers have barriers of their own, see Buffer and
/// Readback.
constexpr GLbitfield kBeforeDispatch = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;
constexpr GLbitfield kBeforeIndirectDispatch = kBeforeDispatch | GL_COMMAND_BARRIER_BIT;

void appendFile(const std::string& folder, const std::string& name, std::set<std::string>& seen, std::string& text);

void appendText(const std::string& folder, std::istream& lines, std::set<std::string>& seen, std::string& text)
{
  std::string line;
  while (std::getline(lines, line))
  {
    std::istringstream words(line);
    std::string word;
    std::string quoted;
    words >> word >> quoted;
    if (word == "#include" && quoted.size() > 2)
      appendFile(folder, quoted.substr(1, quoted.size() - 2), seen, text);
    else if (word != "#pragma")  // the include guard of a file that C++ reads too
      text += line + '\n';
  }
}

void appendFile(const std::string& folder, const std::string& name, std::set<std::string>& seen, std::string& text)
{
  if (!seen.insert(name).second)
    return;
  std::ifstream file(folder + "/" + name);
  if (!file)
    throw Error("shader file " + folder + "/" + name +
                " is missing; install the package, or set GPU_PLANNING_SCENE_SHADERS");
  appendText(folder, file, seen, text);
}

std::string compileLog(GLuint shader)
{
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetShaderInfoLog(shader, length, nullptr, log.data());
  return log;
}

std::string linkLog(GLuint program)
{
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(program, length, nullptr, log.data());
  return log;
}

/// Compiles and links a program. `name` is for messages.
GLuint compile(const std::string& source, const std::string& name)
{
  const char* text = source.c_str();
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good)
  {
    const std::string log = compileLog(shader);
    glDeleteShader(shader);
    throw Error("shader " + name + " does not compile: " + log);
  }
  const GLuint program = glCreateProgram();
  glProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
  glAttachShader(program, shader);
  glLinkProgram(program);
  glDetachShader(program, shader);
  glDeleteShader(shader);
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (!good)
  {
    const std::string log = linkLog(program);
    glDeleteProgram(program);
    throw Error("shader " + name + " does not link: " + log);
  }
  return program;
}

/// "NAME DEFINITION VALUE ...", as short as OpenGL demands.
std::string labelOf(std::string name, const std::string& definitions)
{
  constexpr std::size_t kLongest = 255;  // the least GL_MAX_LABEL_LENGTH, less the final zero
  std::istringstream lines(definitions);
  for (std::string word; lines >> word;)
    if (word != "#define")
      name += " " + word;
  return name.substr(0, kLongest);
}

/// The folder relative to the file of this library, so that an installation can be moved.
std::string installedShaderFolder()
{
  Dl_info library;
  if (dladdr(reinterpret_cast<const void*>(&shaderFolder), &library) == 0)
    return "";
  const auto folder = std::filesystem::canonical(library.dli_fname).parent_path();
  return (folder / GPS_SHADERS_FROM_LIBRARY).lexically_normal().string();
}
}  // namespace

std::string shaderFolder()
{
  const char* chosen = std::getenv("GPU_PLANNING_SCENE_SHADERS");
  if (chosen != nullptr)
    return chosen;
  const std::string installed = installedShaderFolder();
  const std::string source = GPS_SOURCE_SHADERS;  // empty in a binary package
  for (const std::string& folder : {installed, source})
    if (!folder.empty() && std::filesystem::exists(folder + "/shader_constants.h"))
      return folder;
  throw Error("the shaders are not in " + installed + (source.empty() ? "" : ", and not in " + source) +
              "; install the whole package, or set GPU_PLANNING_SCENE_SHADERS");
}

std::string readShader(const std::string& folder, const std::string& name)
{
  std::set<std::string> seen;
  std::string text;
  appendFile(folder, name, seen, text);
  return text;
}

std::size_t groupsFor(std::size_t invocations)
{
  return (invocations + GROUP_SIZE - 1) / GROUP_SIZE;
}

Program::Program(const std::string& folder, const std::string& name, const std::string& definitions)
  : Program(Source{name, "#version 450\n" + definitions + readShader(folder, name), labelOf(name, definitions)})
{
}

Program Program::fromText(const std::string& folder, const std::string& name, const std::string& text)
{
  std::istringstream lines(text);
  std::set<std::string> seen;
  Source source{name, "#version 450\n", labelOf(name, "")};
  appendText(folder, lines, seen, source.text);
  return Program(source);
}

Program::Program(const Source& source)
{
  checkGl(("an operation before compiling " + source.name).c_str());
  id_ = loadCachedProgram(source.text);
  if (id_ == 0)
  {
    id_ = compile(source.text, source.name);
    cacheProgram(id_, source.text);
  }
  glObjectLabel(GL_PROGRAM, id_, static_cast<GLsizei>(source.label.size()), source.label.c_str());
  checkGl(("compiling " + source.name).c_str());
}

Program::~Program()
{
  if (id_)
    glDeleteProgram(id_);
}

Program::Program(Program&& other) noexcept : id_(std::exchange(other.id_, 0)) {}

std::size_t Program::binaryBytes() const
{
  GLint size = 0;
  glGetProgramiv(id_, GL_PROGRAM_BINARY_LENGTH, &size);
  return size > 0 ? static_cast<std::size_t>(size) : 0;
}

void Program::set(int location, std::uint32_t value) const
{
  glProgramUniform1ui(id_, location, value);
}

void Program::setFloat(int location, float value) const
{
  glProgramUniform1f(id_, location, value);
}

void Program::dispatch(std::size_t groups) const
{
  if (groups == 0)
    return;
  const std::size_t rows = (groups + kMaxGroups - 1) / kMaxGroups;
  const std::size_t columns = (groups + rows - 1) / rows;
  if (rows > kMaxGroups)
    throw Error("a dispatch of " + std::to_string(groups) +
                " workgroups exceeds the limit of OpenGL; use a smaller batch");
  glMemoryBarrier(kBeforeDispatch);
  glUseProgram(id_);
  glDispatchCompute(static_cast<GLuint>(columns), static_cast<GLuint>(rows), 1);
}

void Program::dispatchIndirect(const Buffer& arguments, std::size_t offset) const
{
  glMemoryBarrier(kBeforeIndirectDispatch);
  glUseProgram(id_);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments.id());
  glDispatchComputeIndirect(static_cast<GLintptr>(offset));
}
}  // namespace gpu_planning_scene::core
