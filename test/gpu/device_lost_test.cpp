// Errors of the device and resets of its context are reported as DeviceLost, other errors are not.

#include <gtest/gtest.h>

#include <epoxy/gl.h>

#include "gpu/buffer.h"
#include "gpu/expected_gl_errors.h"
#include "gpu/gl_check.h"
#include "gpu/gl_thread.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
/// While this object lives, the driver reports that the context was reset.
class ResetContext
{
 public:
  ResetContext() : true_answer_(epoxy_glGetGraphicsResetStatus)
  {
    epoxy_glGetGraphicsResetStatus = [] { return static_cast<GLenum>(GL_INNOCENT_CONTEXT_RESET); };
  }
  ~ResetContext() { epoxy_glGetGraphicsResetStatus = true_answer_; }

 private:
  PFNGLGETGRAPHICSRESETSTATUSPROC true_answer_;
};

std::string lossIn(GlThread& thread, const std::function<void()>& job)
{
  try
  {
    thread.run(job);
  }
  catch (const DeviceLost& lost)
  {
    return lost.what();
  }
  return {};
}

TEST(DeviceLost, ReportsAResetContextEvenIfTheJobThrows)
{
  GlThread thread("auto");
  int ran = 0;
  EXPECT_EQ(lossIn(thread, [&] { ++ran; }), "");
  {
    const ResetContext reset;
    EXPECT_EQ(lossIn(
                  thread, [&] { ++ran; }),
              "the GPU was reset by another program");
    EXPECT_EQ(lossIn(thread, [] { throw Error("from the job"); }), "the GPU was reset by another program");
  }
  EXPECT_EQ(lossIn(thread, [&] { ++ran; }), "");
  EXPECT_EQ(ran, 3);
}

TEST(DeviceLost, IsAnErrorOfOpenGl)
{
  GlThread thread("auto");
  const std::string error = lossIn(thread,
                                   []
                                   {
                                     const ExpectedGlErrors expected;
                                     glEnable(0xffffu);
                                     checkGl("a wrong call");
                                   });
  EXPECT_EQ(error, "the GPU failed in a wrong call: GL_INVALID_ENUM");
}

TEST(DeviceLost, TooLittleMemoryIsNotALoss)
{
  GlThread thread("auto");
  const auto allocate_too_much = []
  {
    const ExpectedGlErrors expected;
    GLuint buffer = 0;
    glCreateBuffers(1, &buffer);
    glNamedBufferStorage(buffer, GLsizeiptr{1} << 62, nullptr, 0);  // no device has this much memory
    glDeleteBuffers(1, &buffer);
    checkGl("an allocation");
  };
  EXPECT_THROW(thread.run(allocate_too_much), OutOfDeviceMemory);
  EXPECT_EQ(lossIn(thread, [] { Buffer(16); }), "");
}
}  // namespace
}  // namespace gpu_planning_scene::core
