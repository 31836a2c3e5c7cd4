// The program `literature` writes its tables, and fails if this package gives a wrong answer.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tools/run_program.h"

namespace gpu_planning_scene::core
{
namespace
{
std::vector<std::string> linesInFile(const std::string& path)
{
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);)
    lines.push_back(line);
  return lines;
}

std::string newFolder(const std::string& name)
{
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / name;
  std::filesystem::remove_all(folder);
  return folder.string();
}
}  // namespace

TEST(LiteratureProgram, MeasuresEachMethodAtEachDistance)
{
  const std::string folder = newFolder("literature_experiment");
  const ProgramOutput output =
      runProgram(GPS_LITERATURE, {"--quick", "--parts", "experiment", "--out", folder, "--models", "sphere,torus",
                                  "--triangles", "300", "--methods", "exact_cpu,rapid", "--seconds", "0.001"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_EQ(linesInFile(folder + "/methods.csv").size(), 3U);
  EXPECT_EQ(linesInFile(folder + "/builds.csv").size(), 5U);
  EXPECT_EQ(linesInFile(folder + "/experiment.csv").size(), 1U + 2U * 2U * 3U);
  EXPECT_EQ(linesInFile(folder + "/work.csv").size(), 1U + 2U * 3U * 2U);
  EXPECT_GE(linesInFile(folder + "/run.csv").size(), 5U);
}

TEST(LiteratureProgram, CountsMissedAndFalseCollisionsInHardCases)
{
  const std::string folder = newFolder("literature_families");
  const ProgramOutput output =
      runProgram(GPS_LITERATURE, {"--quick", "--parts", "families", "--out", folder, "--methods", "exact_cpu,rapid"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  const std::vector<std::string> lines = linesInFile(folder + "/families.csv");
  ASSERT_GT(lines.size(), 100U);
  EXPECT_EQ(lines.front(),
            "hard_case,level,method,title,family,in_domain,poses,surfaces_collide,solids_collide,missed_surfaces,"
            "false_surfaces,missed_solids,false_solids,within_contract");
  const auto has = [&](const std::string& line) { return std::count(lines.begin(), lines.end(), line) == 1; };
  // A mesh inside another is a collision of solids, not of surfaces.
  EXPECT_TRUE(has("containment,0.1,rapid,oriented boxes (RAPID),trees,no,2,0,2,0,0,2,0,0"));
  EXPECT_TRUE(has("containment,0.1,exact_cpu,\"ours, exact checker\",ours,yes,2,0,2,0,2,0,0,0"));
  EXPECT_TRUE(has("linked tori,0.2,rapid,oriented boxes (RAPID),trees,yes,2,0,0,0,0,0,0,0"));
  EXPECT_TRUE(has("faces in one plane,0,rapid,oriented boxes (RAPID),trees,yes,2,2,2,0,0,0,0,0"));
}

TEST(LiteratureProgram, AnUnknownMethodIsAnError)
{
  const ProgramOutput output = runProgram(GPS_LITERATURE, {"--methods", "magic"});
  EXPECT_EQ(output.exit_code, 2);
  EXPECT_NE(output.err.find("box_tree"), std::string::npos) << output.err;
}
}  // namespace gpu_planning_scene::core
