// Errors of shaders and buffers are detected, and their messages name the cause.

#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "gpu/egl_context.h"
#include "gpu/expected_gl_errors.h"
#include "gpu/program.h"
#include "gpu_planning_scene/error.h"
#include "support/shader_folder.h"

namespace gpu_planning_scene::core
{
namespace
{
class ProgramTest : public testing::Test
{
 protected:
  std::string errorOf(const std::string& name) const
  {
    try
    {
      const Program program(folder_.path(), name);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return {};
  }

  EglContext context_{"auto"};
  ShaderFolder folder_;
};

TEST_F(ProgramTest, CompileErrorsNameTheShader)
{
  const ExpectedGlErrors expected;
  folder_.write("bad.comp", "layout(local_size_x = 1) in;\nvoid main() { undeclared_thing = 1; }\n");
  const std::string error = errorOf("bad.comp");
  EXPECT_NE(error.find("bad.comp"), std::string::npos) << error;
  EXPECT_NE(error.find("undeclared_thing"), std::string::npos) << error;
}

TEST_F(ProgramTest, MissingIncludesAreNamed)
{
  folder_.write("lonely.comp", "#include \"not_there.glsl\"\n");
  EXPECT_NE(errorOf("lonely.comp").find("not_there.glsl"), std::string::npos);
}

TEST_F(ProgramTest, MayHaveMoreWorkgroupsThanOneDimensionHolds)
{
  folder_.write("count.comp",
                "layout(local_size_x = 1) in;\n#include \"common/invocation.glsl\"\n"
                "layout(std430, binding = 0) buffer Count { uint count; uint highest; };\n"
                "void main() { atomicAdd(count, 1u); atomicMax(highest, invocationIndex()); }\n");
  const Program program(folder_.path(), "count.comp");
  Buffer buffer(8);
  buffer.clear();
  buffer.bindStorage(0);
  program.dispatch(70001);
  std::uint32_t result[2] = {};
  buffer.read(result, sizeof(result));
  // The last row of work groups may exceed the requested count, but every index occurs once.
  EXPECT_GE(result[0], 70001U);
  EXPECT_LT(result[0], 70001U + 2U);
  EXPECT_EQ(result[1], result[0] - 1);
}

TEST_F(ProgramTest, BuffersKeepWhatTheyHeldWhenTheyGrow)
{
  std::vector<std::uint32_t> data(1000);
  std::iota(data.begin(), data.end(), 7U);
  TexelBuffer texels;
  texels.reserve(4000);
  texels.buffer().write(data);
  texels.reserve(400000);
  std::vector<std::uint32_t> back(1000);
  texels.buffer().read(back.data(), 4000);
  EXPECT_EQ(back, data);
}

TEST_F(ProgramTest, AccessBeyondABufferIsAnError)
{
  const ExpectedGlErrors expected;
  Buffer buffer(64);
  std::vector<std::uint32_t> data(100);
  EXPECT_THROW(buffer.write(data), Error);
  EXPECT_THROW(buffer.read(data.data(), 400), Error);
}

TEST_F(ProgramTest, MoreTexelsThanTheDeviceHoldsAreRefused)
{
  TexelBuffer texels;
  EXPECT_THROW(texels.reserve(std::size_t{1} << 50), Error);
}

TEST_F(ProgramTest, ABufferThatNoShaderCouldWriteWholeIsRefused)
{
  Buffer buffer(16);
  TexelBuffer texels;
  const std::vector<std::function<void()>> requests = {[&] { buffer.reserve(Buffer::maxBytes() + 1); },
                                                       [&] { texels.reserve(TexelBuffer::maxBytes() + 1); }};
  for (const auto& request : requests)
    try
    {
      request();
      ADD_FAILURE() << "the device may drop what shaders write beyond " << Buffer::maxBytes() << " bytes";
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find("but a shader of this device can use at most"), std::string::npos)
          << error.what();
    }
  EXPECT_EQ(buffer.size(), 16U);
  EXPECT_LE(TexelBuffer::maxBytes(), Buffer::maxBytes());
}
}  // namespace
}  // namespace gpu_planning_scene::core
