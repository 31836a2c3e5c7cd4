#include "gpu/gl_debug.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include <epoxy/gl.h>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string debugMode()
{
  const char* const mode = std::getenv("GPU_PLANNING_SCENE_GL_DEBUG");
  return mode ? mode : "";
}

const char* kindOf(GLenum type)
{
  switch (type)
  {
    case GL_DEBUG_TYPE_ERROR:
      return "error";
    case GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR:
      return "deprecated behaviour";
    case GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR:
      return "undefined behaviour";
    case GL_DEBUG_TYPE_PORTABILITY:
      return "portability";
    case GL_DEBUG_TYPE_PERFORMANCE:
      return "performance";
    default:
      return "other";
  }
}

void GLAPIENTRY report(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity, GLsizei length,
                       const GLchar* text, const void* ends_process)
{
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION)
    return;
  std::fprintf(stderr, "OpenGL, %s: %.*s\n", kindOf(type), static_cast<int>(length), text);
  if (ends_process && type != GL_DEBUG_TYPE_PERFORMANCE)
    std::abort();
}
}  // namespace

bool wantsDebugContext()
{
  const std::string mode = debugMode();
  if (!mode.empty() && mode != "log" && mode != "abort")
    throw Error("the environment variable GPU_PLANNING_SCENE_GL_DEBUG is '" + mode + "'; it must be log or abort");
  return !mode.empty();
}

void reportDriverMessages()
{
  if (!wantsDebugContext())
    return;
  static const char ends_process = 0;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);  // so that a debugger shows the faulty call
  glDebugMessageCallback(report, debugMode() == "abort" ? &ends_process : nullptr);
}
}  // namespace gpu_planning_scene::core
