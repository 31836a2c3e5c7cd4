#include "gpu/fence.h"

#include <string>

#include <epoxy/gl.h>

#include "gpu/gl_check.h"

namespace gpu_planning_scene::core
{
void Fence::place()
{
  drop();
  sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void Fence::wait(const char* what)
{
  constexpr GLuint64 kNanoseconds = 1000000000;
  GLenum state = GL_TIMEOUT_EXPIRED;
  while (state == GL_TIMEOUT_EXPIRED)
  {
    state = glClientWaitSync(static_cast<GLsync>(sync_), GL_SYNC_FLUSH_COMMANDS_BIT, kNanoseconds);
    if (state == GL_TIMEOUT_EXPIRED)
      refuseLostContext();  // its fences may never be reached
  }
  const std::string operation = std::string("waiting for ") + what;
  checkGl(operation.c_str());
  if (state == GL_WAIT_FAILED)
    throw DeviceLost("the GPU failed in " + operation);
  drop();
}

void Fence::drop()
{
  if (sync_)
    glDeleteSync(static_cast<GLsync>(sync_));
  sync_ = nullptr;
}
}  // namespace gpu_planning_scene::core
