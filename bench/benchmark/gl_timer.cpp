#include "benchmark/gl_timer.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

// The entry points of libepoxy are variables. They are replaced by functions that put a timestamp query before and
// after the command. Queries belong to a context, so each thread has its own.
namespace gpu_planning_scene::core::benchmark
{
namespace
{
std::mutex mutex;
std::map<std::string, CommandTime> sums;
std::map<GLuint, std::string> labels;  // of programs

/// A command between two timestamps.
struct TimedCommand
{
  GLuint before;
  GLuint after;
  std::string kind;
};
thread_local std::deque<TimedCommand> running;
thread_local std::vector<GLuint> unused;  // queries
thread_local GLuint current_program = 0;

struct EntryPoints
{
  PFNGLDISPATCHCOMPUTEPROC dispatch;
  PFNGLDISPATCHCOMPUTEINDIRECTPROC dispatch_indirect;
  PFNGLUSEPROGRAMPROC use_program;
  PFNGLCLEARNAMEDBUFFERSUBDATAPROC clear;
  PFNGLCOPYNAMEDBUFFERSUBDATAPROC copy;
  PFNGLCLIENTWAITSYNCPROC wait;
};
EntryPoints original;

GLuint timestamp()
{
  if (unused.empty())
  {
    unused.resize(64);
    glGenQueries(static_cast<GLsizei>(unused.size()), unused.data());
  }
  const GLuint query = unused.back();
  unused.pop_back();
  glQueryCounter(query, GL_TIMESTAMP);
  return query;
}

template <class Command>
void timed(std::string kind, const Command& command)
{
  const GLuint before = timestamp();
  command();
  running.push_back({before, timestamp(), std::move(kind)});
}

std::string labelOf(GLuint program)
{
  const std::lock_guard<std::mutex> lock(mutex);
  std::string& label = labels[program];
  if (label.empty())
  {
    GLsizei length = 0;
    label.resize(256);
    glGetObjectLabel(GL_PROGRAM, program, static_cast<GLsizei>(label.size()), &length, label.data());
    label.resize(static_cast<std::size_t>(std::max(length, 0)));
    if (label.empty())
      label = "program " + std::to_string(program);
  }
  return label;
}

/// Reads the timestamps of the commands that have ended.
void collect()
{
  while (!running.empty())
  {
    const TimedCommand command = running.front();
    GLint ended = 0;
    glGetQueryObjectiv(command.after, GL_QUERY_RESULT_AVAILABLE, &ended);
    if (ended == 0)
      return;
    GLuint64 begin = 0;
    GLuint64 end = 0;
    glGetQueryObjectui64v(command.before, GL_QUERY_RESULT, &begin);
    glGetQueryObjectui64v(command.after, GL_QUERY_RESULT, &end);
    const double seconds = 1e-9 * static_cast<double>(end - begin);
    running.pop_front();
    unused.insert(unused.end(), {command.before, command.after});
    const std::lock_guard<std::mutex> lock(mutex);
    CommandTime& sum = sums[command.kind];
    ++sum.calls;
    sum.seconds += seconds;
    sum.longest = std::max(sum.longest, seconds);
  }
}

bool isMapped(GLuint buffer, GLbitfield access)
{
  GLint is_mapped = 0;
  glGetNamedBufferParameteriv(buffer, GL_BUFFER_MAPPED, &is_mapped);
  GLint flags = 0;
  if (is_mapped != 0)
    glGetNamedBufferParameteriv(buffer, GL_BUFFER_ACCESS_FLAGS, &flags);
  return (static_cast<GLbitfield>(flags) & access) != 0;
}

void GLAPIENTRY dispatch(GLuint x, GLuint y, GLuint z)
{
  timed(
      labelOf(current_program), [&] { original.dispatch(x, y, z); });
}

void GLAPIENTRY dispatchIndirect(GLintptr offset)
{
  timed(
      labelOf(current_program), [&] { original.dispatch_indirect(offset); });
}

void GLAPIENTRY useProgram(GLuint program)
{
  current_program = program;
  original.use_program(program);
}

void GLAPIENTRY clear(GLuint buffer, GLenum internal_format, GLintptr offset, GLsizeiptr size, GLenum format,
                      GLenum type, const void* data)
{
  timed(
      "clear", [&] { original.clear(buffer, internal_format, offset, size, format, type, data); });
}

void GLAPIENTRY copy(GLuint from, GLuint to, GLintptr from_offset, GLintptr to_offset, GLsizeiptr size)
{
  const char* const kind = isMapped(from, GL_MAP_WRITE_BIT) ? "upload"
                           : isMapped(to, GL_MAP_READ_BIT)  ? "readback"
                                                            : "copy";
  timed(kind, [&] { original.copy(from, to, from_offset, to_offset, size); });
}

GLenum GLAPIENTRY wait(GLsync fence, GLbitfield flags, GLuint64 nanoseconds)
{
  const GLenum state = original.wait(fence, flags, nanoseconds);
  collect();
  return state;
}

void use(const EntryPoints& points)
{
  epoxy_glDispatchCompute = points.dispatch;
  epoxy_glDispatchComputeIndirect = points.dispatch_indirect;
  epoxy_glUseProgram = points.use_program;
  epoxy_glClearNamedBufferSubData = points.clear;
  epoxy_glCopyNamedBufferSubData = points.copy;
  epoxy_glClientWaitSync = points.wait;
}
}  // namespace

GlTimer::GlTimer()
{
  original = {epoxy_glDispatchCompute,         epoxy_glDispatchComputeIndirect, epoxy_glUseProgram,
              epoxy_glClearNamedBufferSubData, epoxy_glCopyNamedBufferSubData,  epoxy_glClientWaitSync};
  {
    const std::lock_guard<std::mutex> lock(mutex);
    sums.clear();
    labels.clear();
  }
  use({dispatch, dispatchIndirect, useProgram, clear, copy, wait});
}

GlTimer::~GlTimer()
{
  use(original);
}

std::map<std::string, CommandTime> GlTimer::times()
{
  const std::lock_guard<std::mutex> lock(mutex);
  return sums;
}
}  // namespace gpu_planning_scene::core::benchmark
