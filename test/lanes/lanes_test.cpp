// The project's shaders run on the simulated device without a fault, and the device finds faults that are made on
// purpose. deletions.py does the same for every barrier, every bit of a memory barrier and every `precise`.

#include <array>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "gpu/fence.h"
#include "gpu/program.h"
#include "lanes/gl_device.h"
#include "lanes/workloads.h"
#include "shader_constants.h"
#include "support/shader_folder.h"

namespace gpu_planning_scene::core
{
namespace
{
const std::string kShaders = GPS_SOURCE_DIR "/shaders";

class SimulatedDevice : public testing::Test
{
 protected:
  static void SetUpTestSuite()
  {
    setenv("GPU_PLANNING_SCENE_PROGRAM_CACHE", "off", 1);
    lanes::replaceOpenGl();
  }
  void TearDown() override { lanes::ignoreBarrierBits(0, ""); }

  /// Returns true if one of a few seeds finds a fault. A seed without a fault may have a harmless schedule.
  static bool isFound(const std::string& task, const std::string& shaders)
  {
    constexpr std::uint64_t kSeeds = 5;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
      if (!runWorkload(task, shaders, seed).empty())
        return true;
    return false;
  }
};

TEST_F(SimulatedDevice, FindsNoFaultInTheShaders)
{
  const std::uint64_t seed = std::random_device()();
  RecordProperty("seed", std::to_string(seed));
  for (const std::string& task : workloadNames())
    EXPECT_EQ(runWorkload(task, kShaders, seed), std::vector<std::string>()) << task << ", seed " << seed;
}

TEST_F(SimulatedDevice, FindsAMissingMemoryBarrierBetweenTwoDispatches)
{
  constexpr std::uint32_t kShaderStorage = 0x2000;
  lanes::ignoreBarrierBits(kShaderStorage, "dispatch");
  EXPECT_TRUE(isFound("breadth_first", kShaders));
}

TEST_F(SimulatedDevice, FindsAMissingMemoryBarrierBeforeADownload)
{
  constexpr std::uint32_t kBufferUpdate = 0x200;
  lanes::ignoreBarrierBits(kBufferUpdate, "download");
  EXPECT_TRUE(isFound("buffers", kShaders));
}

/// The words of a buffer that was filled by `fill`, which returns the name of the buffer, or the faults of the device.
template <class Fill>
std::set<std::string> outcomes(const Fill& fill)
{
  std::set<std::string> all;
  constexpr std::uint64_t kSeeds = 40;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
  {
    lanes::device().setSeed(seed);
    lanes::device().clearFaults();
    std::array<std::uint32_t, 2> words = {};
    glGetNamedBufferSubData(fill(), 0, sizeof(words), words.data());
    const std::set<std::string>& faults = lanes::device().faults();
    all.insert(faults.begin(), faults.end());
    if (faults.empty())
      all.insert(std::to_string(words[0]) + " " + std::to_string(words[1]));
  }
  return all;
}

GLuint bufferOf(GLbitfield flags)
{
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  glNamedBufferStorage(buffer, 2 * sizeof(std::uint32_t), nullptr, flags);
  return buffer;
}

void clearWhole(GLuint buffer)
{
  glClearNamedBufferSubData(buffer, GL_R32UI, 0, 2 * sizeof(std::uint32_t), GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

constexpr std::array<std::uint32_t, 2> kNumbers = {7, 8};

TEST_F(SimulatedDevice, LetsAnUploadToADynamicBufferOvertakeAClearOrACopy)
{
  const auto upload = [](GLuint buffer)
  {
    glNamedBufferSubData(buffer, 0, sizeof(std::uint32_t), kNumbers.data());
    return buffer;
  };
  EXPECT_EQ(outcomes(
                [&]
                {
                  const GLuint buffer = bufferOf(GL_DYNAMIC_STORAGE_BIT);
                  clearWhole(buffer);
                  return upload(buffer);
                }),
            (std::set<std::string>{"0 0", "7 0"}));
  EXPECT_EQ(outcomes(
                [&]
                {
                  const GLuint zeros = bufferOf(0);
                  clearWhole(zeros);
                  const GLuint buffer = bufferOf(GL_DYNAMIC_STORAGE_BIT);
                  glCopyNamedBufferSubData(zeros, buffer, 0, 0, 2 * sizeof(std::uint32_t));
                  return upload(buffer);
                }),
            (std::set<std::string>{"0 0", "7 0"}));
  EXPECT_EQ(outcomes([&] { return upload(bufferOf(0)); }),
            std::set<std::string>{"an upload to a buffer without GL_DYNAMIC_STORAGE_BIT"});
}

TEST_F(SimulatedDevice, KeepsTheOrderOfUploadsByCopies)
{
  Buffer buffer;
  EXPECT_EQ(outcomes(
                [&]
                {
                  buffer = Buffer(2 * sizeof(std::uint32_t));
                  buffer.clear();
                  buffer.write(kNumbers.data(), sizeof(std::uint32_t));
                  return buffer.id();
                }),
            std::set<std::string>{"7 0"});
}

TEST_F(SimulatedDevice, FindsMappedMemoryThatIsWrittenBeforeItsCopyWasMade)
{
  constexpr GLbitfield kAccess = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const auto stage = [](bool waits)
  {
    const GLuint staged = bufferOf(kAccess);
    auto* const memory =
        static_cast<std::uint32_t*>(glMapNamedBufferRange(staged, 0, 2 * sizeof(std::uint32_t), kAccess));
    const GLuint buffer = bufferOf(0);
    for (std::uint32_t i = 0; i < 2; ++i)
    {
      *memory = kNumbers[i];
      glCopyNamedBufferSubData(staged, buffer, 0, static_cast<GLintptr>(i * sizeof(std::uint32_t)),
                               sizeof(std::uint32_t));
      Fence fence;
      fence.place();
      if (waits)
        fence.wait("a copy");
    }
    return buffer;
  };
  EXPECT_EQ(outcomes([&] { return stage(true); }), std::set<std::string>{"7 8"});
  EXPECT_EQ(outcomes([&] { return stage(false); })
                .count("the host has overwritten mapped memory that a copy had not read "
                       "yet"),
            1U);
}

/// A deletion in a shader that a task must find.
struct Deletion
{
  const char* deleted;
  const char* file;
  const char* task;
  std::vector<std::array<const char*, 2>> replacements;
};

// One test, because each process compiles the shaders of a new build folder for itself.
TEST_F(SimulatedDevice, FindsEachDeletedStatement)
{
  const std::vector<Deletion> deletions = {
      {"a barrier between the sums of a group and their use",
       "common/prefix_sum.glsl",
       "breadth_first",
       {{"  part_sums[invocation] = sum;\n  barrier();\n", "  part_sums[invocation] = sum;\n"}}},
      {"a barrier before the triangles of the leaf queue",
       "traversal/leaf_queue.glsl",
       "work_queue",
       {{"    barrier();\n    const uint todo", "    const uint todo"}}},
      {"precise, before a difference is rotated",
       "geometry/pose.glsl",
       "transforms",
       {{"precise const vec3 between = b.translation", "const vec3 between = b.translation"}}},
      {"precise, at the product of parallel edges",
       "geometry/triangle_pair.glsl",
       "triangles",
       {{"precise const vec3 axis", "const vec3 axis"}}},
      {"precise, at the corners around a point",
       "geometry/winding_number.glsl",
       "containment",
       {{"precise vec3 c[3]", "vec3 c[3]"}}},
      {"precise, at the line from a solid to a triangle",
       "traversal/solid_leaf.glsl",
       "solids",
       {{"const vec3 n = vectorBetween(q, p)", "const vec3 n = p - q"}}},
      {"precise, at the corners around the centre of a box",
       "tree_build/fit.glsl",
       "boxes",
       {{"precise const vec3 around", "const vec3 around"}}},
      {"precise, between the centres of balls",
       "geometry/pose.glsl",
       "balls",
       {{"precise const vec3 between = to - from", "const vec3 between = to - from"}}},
      {"two times precise, in the reduction of an angle",
       "problem/kinematics.glsl",
       "kinematics",
       {{"precise const double first", "const double first"}, {"precise const double second", "const double second"}}},
  };
  for (const Deletion& deletion : deletions)
  {
    const ShaderFolder shaders;
    for (const auto& [text, replacement] : deletion.replacements)
      shaders.replace(deletion.file, text, replacement);
    EXPECT_TRUE(isFound(deletion.task, shaders.path())) << deletion.deleted;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
