// The project's shaders run on the simulated device without a fault, and the device finds faults that are made on
// purpose. deletions.py does the same for every barrier, every bit of a memory barrier and every `precise`.

#include <cstdlib>
#include <random>

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

TEST_F(SimulatedDevice, FindsAMissingBarrierBetweenTheSumsOfAGroupAndTheirUse)
{
  const ShaderFolder shaders;
  shaders.replace("common/prefix_sum.glsl", "  part_sums[invocation] = sum;\n  barrier();\n",
                  "  part_sums[invocation] = sum;\n");
  EXPECT_TRUE(isFound("breadth_first", shaders.path()));
}

TEST_F(SimulatedDevice, FindsAMissingBarrierBeforeTheTrianglesOfTheLeafQueue)
{
  const ShaderFolder shaders;
  shaders.replace("traversal/leaf_queue.glsl", "    barrier();\n    const uint todo", "    const uint todo");
  EXPECT_TRUE(isFound("work_queue", shaders.path()));
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

TEST_F(SimulatedDevice, FindsAMissingPreciseBeforeADifferenceIsRotated)
{
  const ShaderFolder shaders;
  shaders.replace("geometry/pose.glsl", "precise const vec3 between = b.translation",
                  "const vec3 between = b.translation");
  EXPECT_TRUE(isFound("transforms", shaders.path()));
}

TEST_F(SimulatedDevice, FindsAMissingPreciseAtTheProductOfParallelEdges)
{
  const ShaderFolder shaders;
  shaders.replace("geometry/triangle_pair.glsl", "precise const vec3 axis", "const vec3 axis");
  EXPECT_TRUE(isFound("triangles", shaders.path()));
}

TEST_F(SimulatedDevice, FindsAMissingPreciseAtTheCornersAroundAPoint)
{
  const ShaderFolder shaders;
  shaders.replace("geometry/winding_number.glsl", "precise vec3 c[3]", "vec3 c[3]");
  EXPECT_TRUE(isFound("containment", shaders.path()));
}

TEST_F(SimulatedDevice, FindsAMissingPreciseAtTheLineFromASolidToATriangle)
{
  const ShaderFolder shaders;
  shaders.replace("traversal/solid_leaf.glsl", "const vec3 n = vectorBetween(q, p)", "const vec3 n = p - q");
  EXPECT_TRUE(isFound("solids", shaders.path()));
}

TEST_F(SimulatedDevice, FindsAMissingPreciseAtTheCornersAroundTheCentreOfABox)
{
  const ShaderFolder shaders;
  shaders.replace("tree_build/fit.glsl", "precise const vec3 around", "const vec3 around");
  EXPECT_TRUE(isFound("boxes", shaders.path()));
}

TEST_F(SimulatedDevice, FindsTwoMissingPreciseInTheReductionOfAnAngle)
{
  const ShaderFolder shaders;
  shaders.replace("problem/kinematics.glsl", "precise const double first", "const double first");
  shaders.replace("problem/kinematics.glsl", "precise const double second", "const double second");
  EXPECT_TRUE(isFound("kinematics", shaders.path()));
}
}  // namespace
}  // namespace gpu_planning_scene::core
