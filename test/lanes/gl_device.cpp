#include "lanes/gl_device.h"

#include <cstring>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "lanes/kernel_library.h"

namespace lanes
{
namespace
{
/// A buffer as OpenGL knows it.
struct BufferName
{
  std::uint32_t block;
  GLbitfield flags;       // of glNamedBufferStorage
  GLbitfield mapped_for;  // GL_MAP_READ_BIT, GL_MAP_WRITE_BIT; 0: not mapped
};

std::map<GLuint, Simulator::Program> programs;
using Uniforms = std::map<GLint, std::uint32_t>;  // by location
std::map<GLuint, Uniforms> uniforms;              // by program; programs may share a kernel
std::map<GLuint, std::string> shader_texts;
std::map<GLuint, GLuint> texture_blocks;  // by texture
std::vector<std::string> compiled;
GLuint last_id = 0;
GLuint current_program = 0;
GLuint indirect_block = 0;
std::map<GLuint, BufferName> buffers;
std::uint32_t pending_bits = 0;  // of memory barriers since the last command
std::uint32_t ignored_bits = 0;
std::string ignored_before;  // the kind of command, empty: every command
bool recording = false;
std::recursive_mutex lock;

/// The device, whose commands may not have been executed yet.
Simulator& simulator()
{
  static Simulator device;
  return device;
}

CommandQueue& commands()
{
  return simulator().commands();
}

/// The bits of the memory barriers since the last command. `command`: the kind of the command that follows.
std::uint32_t barrierBits(const char* command)
{
  const bool ignored = ignored_before.empty() || ignored_before == command;
  return std::exchange(pending_bits, 0U) & ~(ignored ? ignored_bits : 0U);
}

/// Gives the device a command. `kind`: for ignoreBarrierBits.
void give(const char* kind, std::function<void()> command)
{
  commands().add(
      [bits = barrierBits(kind), command = std::move(command)]
      {
        simulator().memoryBarrier(bits);
        command();
      });
}

GLenum noError()
{
  return GL_NO_ERROR;
}

void createNames(GLsizei count, GLuint* names)
{
  for (GLsizei i = 0; i < count; ++i)
    names[i] = ++last_id;
}

void bufferStorage(GLuint buffer, GLsizeiptr size, const void* data, GLbitfield flags)
{
  if (data)
    simulator().report("a buffer is made with data, which this device does not know");
  buffers[buffer] = {simulator().addBlock(static_cast<std::size_t>(size)), flags, 0};
}

void deleteBuffers(GLsizei count, const GLuint* names)
{
  for (GLsizei i = 0; i < count; ++i)
  {
    commands().add([block = buffers.at(names[i]).block] { simulator().removeBlock(block); });
    buffers.erase(names[i]);
  }
}

/// An upload to a buffer that the host may write. As with NVIDIA's driver, it happens at once, so it may overtake
/// commands that were given before.
void bufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, const void* data)
{
  const BufferName& to = buffers.at(buffer);
  if ((to.flags & GL_DYNAMIC_STORAGE_BIT) == 0)
    return simulator().report("an upload to a buffer without GL_DYNAMIC_STORAGE_BIT");
  simulator().memoryBarrier(barrierBits("upload"));
  simulator().commandWrite(to.block, static_cast<std::size_t>(offset), static_cast<std::size_t>(size), data);
}

void getBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, void* data)
{
  give("download",
       [=, block = buffers.at(buffer).block]
       {
         simulator().commandRead(block, static_cast<std::size_t>(offset), static_cast<std::size_t>(size), data,
                                 BufferUpdate);
       });
  commands().finish();
}

void clearBufferSubData(GLuint buffer, GLenum, GLintptr offset, GLsizeiptr size, GLenum, GLenum, const void* word)
{
  give(
      "clear",
      [=, block = buffers.at(buffer).block, value = word ? *static_cast<const std::uint32_t*>(word) : 0U]
      {
        const std::vector<std::uint32_t> words(static_cast<std::size_t>(size) / sizeof(value), value);
        simulator().commandWrite(block, static_cast<std::size_t>(offset), words.size() * sizeof(value), words.data());
      });
}

/// The bytes of a buffer at this moment.
std::vector<char> bytesOf(std::uint32_t block, GLintptr offset, GLsizeiptr size)
{
  const Block& from = simulator().block(block);
  const char* const first = reinterpret_cast<const char*>(from.values.get()) + offset;
  return offset + size > static_cast<GLintptr>(from.bytes) ? std::vector<char>()
                                                           : std::vector<char>(first, first + size);
}

void copyBufferSubData(GLuint from, GLuint to, GLintptr from_offset, GLintptr to_offset, GLsizeiptr size)
{
  const BufferName& source = buffers.at(from);
  const BufferName& target = buffers.at(to);
  const bool is_upload = (source.mapped_for & GL_MAP_WRITE_BIT) != 0;
  const bool is_readback = (target.mapped_for & GL_MAP_READ_BIT) != 0;
  std::vector<char> given;  // what the host has written for this copy
  if (is_upload)
    given = bytesOf(source.block, from_offset, size);
  give(is_upload     ? "upload"
       : is_readback ? "readback"
                     : "copy",
       [=, from_block = source.block, to_block = target.block, given = std::move(given)]
       {
         std::vector<char> bytes(static_cast<std::size_t>(size));
         simulator().commandRead(from_block, static_cast<std::size_t>(from_offset), bytes.size(), bytes.data(),
                                 BufferUpdate);
         if (is_upload && bytes != given)
           simulator().report("the host has overwritten mapped memory that a copy had not read yet");
         simulator().commandWrite(to_block, static_cast<std::size_t>(to_offset), bytes.size(), bytes.data());
       });
}

void bindBufferBase(GLenum, GLuint binding, GLuint buffer)
{
  if (buffer == 0)
    return commands().add([=] { simulator().unbindStorage(binding); });
  const std::uint32_t block = buffers.at(buffer).block;
  commands().add([=] { simulator().bindStorage(binding, block, 0, simulator().block(block).bytes); });
}

void bindBufferRange(GLenum, GLuint binding, GLuint buffer, GLintptr offset, GLsizeiptr size)
{
  commands().add(
      [=, block = buffers.at(buffer).block]
      { simulator().bindStorage(binding, block, static_cast<std::size_t>(offset), static_cast<std::size_t>(size)); });
}

void bindBuffer(GLenum, GLuint buffer)
{
  indirect_block = buffers.at(buffer).block;
}

void* mapBufferRange(GLuint buffer, GLintptr offset, GLsizeiptr, GLbitfield access)
{
  BufferName& mapped = buffers.at(buffer);
  constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  if ((access & kAccess & ~mapped.flags) != 0)
    simulator().report("a buffer is mapped in a way that its storage does not allow");
  if ((access & GL_MAP_PERSISTENT_BIT) == 0 || (access & GL_MAP_COHERENT_BIT) == 0)
    simulator().report("a buffer is mapped, but not persistently and coherently");
  mapped.mapped_for = access & (GL_MAP_READ_BIT | GL_MAP_WRITE_BIT);
  return reinterpret_cast<char*>(simulator().block(mapped.block).values.get()) + offset;
}

void createTextures(GLenum, GLsizei count, GLuint* names)
{
  createNames(count, names);
}

void deleteTextures(GLsizei, const GLuint*) {}

void textureBuffer(GLuint texture, GLenum, GLuint buffer)
{
  texture_blocks[texture] = buffer == 0 ? 0 : buffers.at(buffer).block;
}

void bindTextureUnit(GLuint unit, GLuint texture)
{
  commands().add([=, block = texture_blocks[texture]] { simulator().bindTexture(unit, block); });
}

void getIntegerv(GLenum name, GLint* value)
{
  const bool is_limit = name == GL_MAX_TEXTURE_BUFFER_SIZE || name == GL_MAX_SHADER_STORAGE_BLOCK_SIZE;
  *value = is_limit ? 1 << 27 : 0;
}

void memoryBarrier(GLbitfield bits)
{
  pending_bits |= bits;
}

GLuint createName(GLenum)
{
  return ++last_id;
}

GLuint createProgram()
{
  return ++last_id;
}

void shaderSource(GLuint shader, GLsizei, const GLchar* const* texts, const GLint*)
{
  shader_texts[shader] = texts[0];
  compiled.emplace_back(texts[0]);
}

void onShader(GLuint) {}

void getStatus(GLuint, GLenum, GLint* value)
{
  *value = 1;
}

void attachShader(GLuint program, GLuint shader)
{
  if (recording)
    return;
  programs[program] = loadKernel(shader_texts.at(shader));
}

void onProgramAndShader(GLuint, GLuint) {}
void onProgramParameter(GLuint, GLenum, GLint) {}
void objectLabel(GLenum, GLuint, GLsizei, const GLchar*) {}

void setUniform(GLuint program, GLint location, const void* value)
{
  std::memcpy(&uniforms[program][location], value, sizeof(std::uint32_t));
}

/// Runs a program with the values that its uniforms had when the dispatch was given.
void runProgram(GLuint program, const Uniforms& values, GLuint columns, GLuint rows)
{
  const Kernel& kernel = *programs.at(program).kernel;
  for (std::uint32_t i = 0; i < kernel.variable_count; ++i)
    if (const Variable& variable = kernel.variables[i]; variable.kind == Variable::Uniform)
    {
      const auto value = values.find(static_cast<GLint>(variable.place));
      const std::uint32_t bits = value == values.end() ? 0U : value->second;
      std::memcpy(variable.value, &bits, sizeof(bits));
    }
  simulator().dispatch(programs.at(program), columns, rows);
}

void uniform1ui(GLuint program, GLint location, GLuint value)
{
  setUniform(program, location, &value);
}

void uniform1f(GLuint program, GLint location, GLfloat value)
{
  setUniform(program, location, &value);
}

void useProgram(GLuint program)
{
  current_program = program;
}

void dispatchCompute(GLuint columns, GLuint rows, GLuint)
{
  if (recording)
    return;
  give("dispatch", [=, program = current_program, values = uniforms[current_program]]
       { runProgram(program, values, columns, rows); });
}

void dispatchComputeIndirect(GLintptr offset)
{
  if (recording)
    return;
  give("indirect dispatch",
       [=, program = current_program, values = uniforms[current_program], block = indirect_block]
       {
         GLuint groups[3] = {};
         simulator().commandRead(block, static_cast<std::size_t>(offset), sizeof(groups), groups, Command);
         runProgram(program, values, groups[0], groups[2] == 0 ? 0 : groups[1]);
       });
}

/// A fence is the number of the last command before it.
GLsync fenceSync(GLenum, GLbitfield)
{
  commands().add([] {});                                    // so that the number is not 0
  return reinterpret_cast<GLsync>(commands().lastAdded());  // NOLINT(performance-no-int-to-ptr): OpenGL's type
}

GLenum clientWaitSync(GLsync fence, GLbitfield, GLuint64)
{
  const auto last = reinterpret_cast<CommandQueue::Serial>(fence);
  if (commands().lastExecuted() >= last)
    return GL_ALREADY_SIGNALED;
  if (commands().oneIn(4))
    return GL_TIMEOUT_EXPIRED;
  commands().finish(last);
  return GL_CONDITION_SATISFIED;
}

void deleteSync(GLsync) {}
void flush() {}

/// The same function, for one thread at a time: each checker has a thread of its own.
template <auto function>
struct Locked;
template <class R, class... A, R (*function)(A...)>
struct Locked<function>
{
  static R call(A... arguments)
  {
    const std::lock_guard<std::recursive_mutex> guard(lock);
    return function(arguments...);
  }
};
}  // namespace

void replaceOpenGl()
{
  epoxy_glGetError = Locked<noError>::call;
  epoxy_glGetGraphicsResetStatus = Locked<noError>::call;
  epoxy_glCreateBuffers = Locked<createNames>::call;
  epoxy_glNamedBufferStorage = Locked<bufferStorage>::call;
  epoxy_glDeleteBuffers = Locked<deleteBuffers>::call;
  epoxy_glNamedBufferSubData = Locked<bufferSubData>::call;
  epoxy_glGetNamedBufferSubData = Locked<getBufferSubData>::call;
  epoxy_glClearNamedBufferSubData = Locked<clearBufferSubData>::call;
  epoxy_glCopyNamedBufferSubData = Locked<copyBufferSubData>::call;
  epoxy_glBindBufferBase = Locked<bindBufferBase>::call;
  epoxy_glBindBufferRange = Locked<bindBufferRange>::call;
  epoxy_glBindBuffer = Locked<bindBuffer>::call;
  epoxy_glMapNamedBufferRange = Locked<mapBufferRange>::call;
  epoxy_glCreateTextures = Locked<createTextures>::call;
  epoxy_glDeleteTextures = Locked<deleteTextures>::call;
  epoxy_glTextureBuffer = Locked<textureBuffer>::call;
  epoxy_glBindTextureUnit = Locked<bindTextureUnit>::call;
  epoxy_glGetIntegerv = Locked<getIntegerv>::call;
  epoxy_glMemoryBarrier = Locked<memoryBarrier>::call;
  epoxy_glCreateShader = Locked<createName>::call;
  epoxy_glCreateProgram = Locked<createProgram>::call;
  epoxy_glShaderSource = Locked<shaderSource>::call;
  epoxy_glCompileShader = Locked<onShader>::call;
  epoxy_glDeleteShader = Locked<onShader>::call;
  epoxy_glLinkProgram = Locked<onShader>::call;
  epoxy_glDeleteProgram = Locked<onShader>::call;
  epoxy_glGetShaderiv = Locked<getStatus>::call;
  epoxy_glGetProgramiv = Locked<getStatus>::call;
  epoxy_glAttachShader = Locked<attachShader>::call;
  epoxy_glDetachShader = Locked<onProgramAndShader>::call;
  epoxy_glProgramParameteri = Locked<onProgramParameter>::call;
  epoxy_glObjectLabel = Locked<objectLabel>::call;
  epoxy_glProgramUniform1ui = Locked<uniform1ui>::call;
  epoxy_glProgramUniform1f = Locked<uniform1f>::call;
  epoxy_glUseProgram = Locked<useProgram>::call;
  epoxy_glDispatchCompute = Locked<dispatchCompute>::call;
  epoxy_glDispatchComputeIndirect = Locked<dispatchComputeIndirect>::call;
  epoxy_glFenceSync = Locked<fenceSync>::call;
  epoxy_glClientWaitSync = Locked<clientWaitSync>::call;
  epoxy_glDeleteSync = Locked<deleteSync>::call;
  epoxy_glFlush = Locked<flush>::call;
}

Simulator& device()
{
  return simulator();
}

const std::vector<std::string>& compiledShaders()
{
  return compiled;
}

void recordOnly()
{
  recording = true;
}

void ignoreBarrierBits(std::uint32_t bits, const std::string& command)
{
  ignored_bits = bits;
  ignored_before = command;
}
}  // namespace lanes
