// The project's shaders run on the simulated device without a fault, and the device finds faults that are made on
// purpose. deletions.py does the same for every barrier, every bit of a memory barrier and every `precise`.

#include <array>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lanes/gl_device.h"
#include "lanes/workloads.h"
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

  static void expectNoFault(std::uint64_t seed)
  {
    for (const std::string& task : workloadNames())
      EXPECT_EQ(runWorkload(task, kShaders, seed), std::vector<std::string>()) << task << ", seed " << seed;
  }
};

TEST_F(SimulatedDevice, FindsNoFaultInTheShaders)
{
  expectNoFault(1);
}

TEST_F(SimulatedDevice, FindsNoFaultInTheShadersWithARandomSeed)
{
  const std::uint64_t seed = std::random_device()();
  SCOPED_TRACE("seed " + std::to_string(seed));
  RecordProperty("seed", std::to_string(seed));
  expectNoFault(seed);
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
       "broad_phase/covers.glsl",
       "balls",
       {{"vectorBetween(a, b);\n  return provenGreater", "b - a;\n  return provenGreater"}}},
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
