#pragma once

#include <epoxy/gl.h>

namespace gpu_planning_scene::core
{
/// While this object lives, messages of the driver do not end the test: the test makes errors on purpose. Lives on the
/// thread of the context.
class ExpectedGlErrors
{
 public:
  ExpectedGlErrors() { glDisable(GL_DEBUG_OUTPUT); }
  ~ExpectedGlErrors() { glEnable(GL_DEBUG_OUTPUT); }
  ExpectedGlErrors(const ExpectedGlErrors&) = delete;
  ExpectedGlErrors& operator=(const ExpectedGlErrors&) = delete;
};
}  // namespace gpu_planning_scene::core
