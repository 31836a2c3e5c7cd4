// The stability program finds no wrong answers. It does find them, and fails, after a test removes the shaders' error
// bounds, their undecided answers, or the containment stage.

#include <gtest/gtest.h>

#include "support/repetitions.h"
#include "support/shader_folder.h"
#include "tools/run_program.h"

namespace gpu_planning_scene::core
{
namespace
{
ProgramOutput runStability(const std::vector<std::string>& arguments)
{
  return runProgram(GPS_STABILITY, arguments);
}

/// Expects that the program finds wrong answers of the changed shaders. `family`: part of a family's name.
void expectFailure(const ShaderFolder& shaders, const std::string& family)
{
  const ProgramOutput output = runStability({"--cases", "64", "--family", family, "--shaders", shaders.path()});
  EXPECT_EQ(output.exit_code, 1) << output.err;
  EXPECT_NE(output.err.find("wrong answers"), std::string::npos) << output.err;
  EXPECT_NE(output.err.find("ours, work queues is wrong"), std::string::npos) << output.err;
  EXPECT_NE(output.err.find("ours, breadth-first is wrong"), std::string::npos) << output.err;
  EXPECT_EQ(output.err.find("ours, exact checker is wrong"), std::string::npos) << output.err;
}
}  // namespace

TEST(Stability, NoAnswerIsWrongInAnyFamily)
{
  const ProgramOutput output = runStability({"--quick", "--cases", repetitions("2", "20")});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_NE(output.out.find("| random rigid motions |"), std::string::npos) << output.out;
}

// The oracle judges the undamaged meshes: here the closing of damaged meshes is tested too.
TEST(Stability, NoAnswerIsWrongInDamagedMeshes)
{
  const ProgramOutput output =
      runStability({"--family", "leaky", "--cases", repetitions("32", "10000"), "--proofs", repetitions("2", "1000")});
  EXPECT_EQ(output.exit_code, 0) << output.err;
}

TEST(Stability, NoticesErrorBoundsOfZero)
{
  const ShaderFolder shaders;
  // Not in the kernels that build trees: wrong trees are noticed before a state is checked.
  shaders.replace("geometry/error_bounds.glsl", "const float u = UNIT_ROUNDOFF;", "const float u = 0.0;");
  expectFailure(shaders, "random rigid motions");
}

TEST(Stability, NoticesUndecidedAnswersThatAreDropped)
{
  const ShaderFolder shaders;
  shaders.replace("traversal/verdicts.glsl", "  else\n    reportUndecided(state);", "");
  expectFailure(shaders, "random rigid motions");
}

TEST(Stability, NoticesThatContainmentInMeshesIsNotTested)
{
  const ShaderFolder shaders;
  shaders.replace("traversal/containment.comp", "void main()\n{\n", "void main()\n{\n  return;\n");
  expectFailure(shaders, "in or near a closed mesh");
}

TEST(Stability, NoticesThatContainmentInPrimitivesIsNotTested)
{
  const ShaderFolder shaders;
  shaders.replace("broad_phase/root_pairs.comp", "if (inside != 0u)", "if (false)");
  shaders.replace("broad_phase/root_pairs.comp", "if ((inside & STATE_HIT) != 0u)", "if (false)");
  shaders.replace("traversal/bounding_volume_overlap.glsl",
                  "return all(lessThan(b_in_a, core_a)) || all(lessThan(a_in_b, core_b));", "return false;");
  shaders.replace("traversal/solid_leaf.glsl", "found = STATE_HIT;", "found = 0u;");
  expectFailure(shaders, "mesh in or near a primitive");
}

TEST(Stability, ReportsAFamilyThatIsNotThere)
{
  const ProgramOutput output = runStability({"--family", "nothing like this"});
  EXPECT_EQ(output.exit_code, 2);
  EXPECT_NE(output.err.find("random rigid motions"), std::string::npos) << output.err;
}
}  // namespace gpu_planning_scene::core
