#include "gpu/gl_check.h"

#include <string>

#include <epoxy/gl.h>

namespace gpu_planning_scene::core
{
namespace
{
const char* errorName(GLenum error)
{
  switch (error)
  {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST";
    default:
      return "an unknown OpenGL error";
  }
}
}  // namespace

void checkGl(const char* where)
{
  const GLenum first = glGetError();
  if (first == GL_NO_ERROR)
    return;
  // Several flags may be set, one for each kind of error. A lost context reports its error for ever.
  for (int i = 0; i < 8 && glGetError() != GL_NO_ERROR; ++i)
  {
  }
  const std::string message = std::string("the GPU failed in ") + where + ": " + errorName(first);
  if (first == GL_OUT_OF_MEMORY)
    throw OutOfDeviceMemory(message);
  throw DeviceLost(message);
}

void refuseLostContext()
{
  const char* cause = nullptr;
  switch (glGetGraphicsResetStatus())
  {
    case GL_NO_ERROR:
      return;
    case GL_GUILTY_CONTEXT_RESET:
      cause = "because of the work of this program";
      break;
    case GL_INNOCENT_CONTEXT_RESET:
      cause = "by another program";
      break;
    default:
      cause = "for an unknown reason";
  }
  throw DeviceLost(std::string("the GPU was reset ") + cause);
}
}  // namespace gpu_planning_scene::core
