#include "lanes/gl_device.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "lanes/kernel_library.h"

namespace lanes
{
namespace
{
std::map<GLuint, Simulator::Program> programs;
std::map<GLuint, std::map<GLint, std::uint32_t>> uniforms;  // by program and location; programs may share a kernel
std::map<GLuint, std::string> shader_texts;
std::map<GLuint, GLuint> texture_blocks;  // by texture
std::vector<std::string> compiled;
GLuint last_id = 0;
GLuint current_program = 0;
GLuint indirect_block = 0;
std::map<GLuint, GLuint> blocks;  // by buffer
std::set<GLuint> mapped;          // buffers
std::uint32_t pending_bits = 0;   // of memory barriers since the last command
std::uint32_t ignored_bits = 0;
std::string ignored_before;  // the kind of command, empty: every command
bool recording = false;
std::recursive_mutex lock;

/// The counts of the host's work, if there are any, else some that nobody reads.
HostWork& hostWork()
{
  static HostWork unread;
  return device().counts() ? device().counts()->host : unread;
}

void countUpload(GLsizeiptr bytes)
{
  ++hostWork().uploads;
  hostWork().uploaded_bytes += static_cast<std::uint64_t>(bytes);
}

void countDownload(GLsizeiptr bytes)
{
  ++hostWork().downloads;
  hostWork().downloaded_bytes += static_cast<std::uint64_t>(bytes);
}

/// Lets the memory barriers since the last command take effect. `command`: the kind of the command that follows.
void applyBarriers(const char* command)
{
  const bool ignored = ignored_before.empty() || ignored_before == command;
  device().memoryBarrier(pending_bits & ~(ignored ? ignored_bits : 0U));
  pending_bits = 0;
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

void bufferStorage(GLuint buffer, GLsizeiptr size, const void*, GLbitfield)
{
  blocks[buffer] = device().addBlock(static_cast<std::size_t>(size));
}

void deleteBuffers(GLsizei count, const GLuint* buffers)
{
  for (GLsizei i = 0; i < count; ++i)
  {
    device().removeBlock(blocks.at(buffers[i]));
    blocks.erase(buffers[i]);
    mapped.erase(buffers[i]);
  }
}

void writeBuffer(GLuint buffer, GLintptr offset, GLsizeiptr size, const void* data)
{
  device().commandWrite(blocks.at(buffer), static_cast<std::size_t>(offset), static_cast<std::size_t>(size), data);
}

void readBuffer(GLuint buffer, GLintptr offset, GLsizeiptr size, void* data)
{
  device().commandRead(blocks.at(buffer), static_cast<std::size_t>(offset), static_cast<std::size_t>(size), data,
                       BufferUpdate);
}

void bufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, const void* data)
{
  countUpload(size);
  applyBarriers("upload");
  writeBuffer(buffer, offset, size, data);
}

void getBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, void* data)
{
  countDownload(size);
  ++hostWork().waits;
  applyBarriers("download");
  readBuffer(buffer, offset, size, data);
}

void clearBufferSubData(GLuint buffer, GLenum, GLintptr offset, GLsizeiptr size, GLenum, GLenum, const void*)
{
  applyBarriers("clear");
  const std::vector<char> zeros(static_cast<std::size_t>(size));
  writeBuffer(buffer, offset, size, zeros.data());
}

void copyBufferSubData(GLuint from, GLuint to, GLintptr from_offset, GLintptr to_offset, GLsizeiptr size)
{
  const bool is_readback = mapped.count(to) > 0;
  if (is_readback)
    countDownload(size);
  applyBarriers(is_readback ? "readback" : "copy");
  std::vector<char> bytes(static_cast<std::size_t>(size));
  readBuffer(from, from_offset, size, bytes.data());
  writeBuffer(to, to_offset, size, bytes.data());
}

void bindBufferBase(GLenum, GLuint binding, GLuint buffer)
{
  if (buffer == 0)
    return device().unbindStorage(binding);
  const GLuint block = blocks.at(buffer);
  device().bindStorage(binding, block, 0, device().block(block).bytes);
}

void bindBufferRange(GLenum, GLuint binding, GLuint buffer, GLintptr offset, GLsizeiptr size)
{
  device().bindStorage(binding, blocks.at(buffer), static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
}

void bindBuffer(GLenum, GLuint buffer)
{
  indirect_block = blocks.at(buffer);
}

void* mapBufferRange(GLuint buffer, GLintptr offset, GLsizeiptr, GLbitfield)
{
  mapped.insert(buffer);
  return reinterpret_cast<char*>(device().block(blocks.at(buffer)).values.get()) + offset;
}

void createTextures(GLenum, GLsizei count, GLuint* names)
{
  createNames(count, names);
}

void deleteTextures(GLsizei, const GLuint*) {}

void textureBuffer(GLuint texture, GLenum, GLuint buffer)
{
  texture_blocks[texture] = buffer == 0 ? 0 : blocks.at(buffer);
}

void bindTextureUnit(GLuint unit, GLuint texture)
{
  device().bindTexture(unit, texture_blocks[texture]);
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

void setUniform(GLuint program, GLint location, const void* value)
{
  std::memcpy(&uniforms[program][location], value, sizeof(std::uint32_t));
}

/// Gives a kernel the uniforms of a program.
void writeUniforms(GLuint program)
{
  const Kernel& kernel = *programs.at(program).kernel;
  for (std::uint32_t i = 0; i < kernel.variable_count; ++i)
    if (kernel.variables[i].kind == Variable::Uniform)
      std::memcpy(kernel.variables[i].value, &uniforms[program][static_cast<GLint>(kernel.variables[i].place)],
                  sizeof(std::uint32_t));
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

void runProgram(GLuint columns, GLuint rows)
{
  writeUniforms(current_program);
  device().dispatch(programs.at(current_program), columns, rows);
}

void dispatchCompute(GLuint columns, GLuint rows, GLuint)
{
  if (recording)
    return;
  applyBarriers("dispatch");
  runProgram(columns, rows);
}

void dispatchComputeIndirect(GLintptr offset)
{
  if (recording)
    return;
  applyBarriers("indirect dispatch");
  GLuint groups[3] = {};
  device().commandRead(indirect_block, static_cast<std::size_t>(offset), sizeof(groups), groups, Command);
  runProgram(groups[0], groups[2] == 0 ? 0 : groups[1]);
}

GLsync fenceSync(GLenum, GLbitfield)
{
  return reinterpret_cast<GLsync>(&last_id);
}

GLenum clientWaitSync(GLsync, GLbitfield, GLuint64)
{
  ++hostWork().waits;
  return GL_ALREADY_SIGNALED;
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
    ++hostWork().calls;
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
  static Simulator simulator;
  return simulator;
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
