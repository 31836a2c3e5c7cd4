// Messages of the driver about errors are reported if the environment asks for it.

#include <cstdlib>

#include <gtest/gtest.h>

#include <epoxy/gl.h>

#include "gpu/egl_context.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr GLenum kNoCapability = 0xffff;

/// Sets GPU_PLANNING_SCENE_GL_DEBUG while it lives.
class DebugMode
{
 public:
  explicit DebugMode(const char* mode)
  {
    if (const char* const before = std::getenv(kName))
      before_ = before;
    setenv(kName, mode, 1);
  }
  ~DebugMode()
  {
    if (before_.empty())
      unsetenv(kName);
    else
      setenv(kName, before_.c_str(), 1);
  }
  DebugMode(const DebugMode&) = delete;
  DebugMode& operator=(const DebugMode&) = delete;

 private:
  static constexpr const char* kName = "GPU_PLANNING_SCENE_GL_DEBUG";
  std::string before_;
};

TEST(GlDebug, AnErrorIsLogged)
{
  const DebugMode mode("log");
  const EglContext context("auto");
  testing::internal::CaptureStderr();
  glEnable(kNoCapability);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("OpenGL, error: "), std::string::npos);
}

TEST(GlDebugDeathTest, AnErrorEndsTheProcess)
{
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(
      {
        const DebugMode mode("abort");
        const EglContext context("auto");
        glEnable(kNoCapability);
      },
      "OpenGL, error: ");
}

TEST(GlDebug, AnUnknownModeIsRefused)
{
  const DebugMode mode("verbose");
  try
  {
    const EglContext context("auto");
    ADD_FAILURE();
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(),
                 "the environment variable GPU_PLANNING_SCENE_GL_DEBUG is 'verbose'; it must be log or abort");
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
