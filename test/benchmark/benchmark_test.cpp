// The benchmark program writes its tables and the script draws them. Wrong answers are counted. Wrong answers of an
// exact method are an error.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "benchmark/statistics.h"
#include "peers/vamp/vamp_check.h"
#include "support/shader_folder.h"
#include "support/test_scenes.h"
#include "tools/run_program.h"

namespace gpu_planning_scene::core
{
namespace
{
using Row = std::map<std::string, std::string>;
using Table = std::vector<Row>;

/// A temporary folder. The destructor removes it.
class TemporaryFolder
{
 public:
  TemporaryFolder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "benchmark_testXXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::vector<std::string> cellsOf(const std::string& line)
{
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line)
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

Table readTable(const std::string& path)
{
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> titles = cellsOf(line);
  Table table;
  while (std::getline(file, line))
  {
    const std::vector<std::string> cells = cellsOf(line);
    EXPECT_EQ(cells.size(), titles.size()) << path << ": " << line;
    Row row;
    for (std::size_t i = 0; i < std::min(cells.size(), titles.size()); ++i)
      row[titles[i]] = cells[i];
    table.push_back(row);
  }
  return table;
}

double number(const Row& row, const std::string& column)
{
  return std::strtod(row.at(column).c_str(), nullptr);
}

double wrongAnswers(const Row& row)
{
  return number(row, "wrong_free") + number(row, "wrong_collision");
}

ProgramOutput runBenchmark(const std::string& out, std::vector<std::string> arguments)
{
  arguments.insert(arguments.end(), {"--quick", "--out", out, "--states", "96", "--repeats", "1", "--seconds", "0.01"});
  return runProgram(GPS_BENCHMARK, arguments);
}
}  // namespace

TEST(Benchmark, CountsRightAndWrongAnswers)
{
  const TemporaryFolder folder;
  const std::string ours = "exact_cpu,ours_auto,ours_work_queue,ours_breadth_first";
  const std::string peers = "fcl_obbrss,fcl_obbrss_ordered,bullet_hulls,spheres_4";
  const ProgramOutput output = runBenchmark(folder.path(), {"--parts", "throughput", "--scenes", "arm_boxes",
                                                            "--batches", "32", "--methods", ours + "," + peers});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const Table accuracy = readTable(folder.path() + "/accuracy.csv");
  EXPECT_EQ(accuracy.size(), 2U * 8U);  // two kinds of states
  for (const Row& row : accuracy)
  {
    if (row.at("claims_exact") == "yes")
    {
      EXPECT_EQ(wrongAnswers(row), 0.0) << row.at("method");
      EXPECT_EQ(number(row, "largest_error_m"), 0.0) << row.at("method");
    }
    const bool known_to_be_wrong = row.at("method") == "spheres_4" || row.at("method") == "bullet_hulls";
    if (known_to_be_wrong && row.at("kind") == "near_contact")
    {
      EXPECT_GT(wrongAnswers(row), 0.0) << row.at("method");
      EXPECT_GT(number(row, "largest_error_m"), 1e-10) << row.at("method");
      EXPECT_LT(number(row, "largest_error_m"), 0.5) << row.at("method");
    }
  }
  for (const Row& row : readTable(folder.path() + "/throughput.csv"))
  {
    EXPECT_GT(number(row, "states_per_s"), 0.0) << row.at("method");
    EXPECT_GT(number(row, "of_fcl_obbrss"), 0.0) << row.at("method");
    EXPECT_GT(number(row, "of_fcl_ordered"), 0.0) << row.at("method");
    EXPECT_EQ(row.at("device_share").empty(), row.at("method") != "ours_auto") << row.at("method");
    EXPECT_GT(number(row, "valid_share"), 0.1);
    EXPECT_EQ(number(row, "node_visits_a_state") > 0.0, row.at("method") == "exact_cpu") << row.at("method");
    const bool on_gpu = row.at("method") == "ours_work_queue" || row.at("method") == "ours_breadth_first";
    if (row.at("method") != "ours_auto")
      EXPECT_EQ(row.at("root_pairs_a_state").empty(), !on_gpu) << row.at("method");
    if (on_gpu)
    {
      EXPECT_GT(number(row, "root_pairs_a_state"), 0.0) << row.at("method");
      EXPECT_GE(number(row, "candidates_a_state"), number(row, "root_pairs_a_state")) << row.at("method");
    }
  }
}

TEST(Median, IsTheMiddle)
{
  EXPECT_EQ(benchmark::median({3.0, 1.0}), 2.0);
  EXPECT_EQ(benchmark::median({5.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(benchmark::median({4.0}), 4.0);
  EXPECT_TRUE(std::isnan(benchmark::median(std::vector<double>())));
}

TEST(Benchmark, FailsWhereAnExactMethodIsWrong)
{
  const TemporaryFolder folder;
  const ShaderFolder shaders;
  // Not in the kernels that build trees: wrong trees are noticed before a state is checked.
  shaders.replace("geometry/error_bounds.glsl", "const float u = UNIT_ROUNDOFF;", "const float u = 0.0;");
  shaders.define("CONTRACT_BAND", "0.0");
  setenv("GPU_PLANNING_SCENE_SHADERS", shaders.path().c_str(), 1);
  const ProgramOutput output = runBenchmark(folder.path(), {"--parts", "throughput", "--scenes", "arm_boxes", "--kinds",
                                                            "near_contact", "--methods", "ours_work_queue"});
  unsetenv("GPU_PLANNING_SCENE_SHADERS");
  EXPECT_EQ(output.exit_code, 1);
  EXPECT_NE(output.err.find("ours, work queues"), std::string::npos) << output.err;
  EXPECT_NE(output.err.find("wrong answers of methods that claim to be exact"), std::string::npos) << output.err;
}

/// With these shaders every pair in the narrow phase is free. The timed answers must reveal this.
TEST(Benchmark, FailsWhereATimedAnswerIsWrong)
{
  const TemporaryFolder folder;
  const ShaderFolder shaders;
  shaders.replace("traversal/verdicts.glsl",
                  "atomicExchange(verdicts[state], pair);\n  else\n    reportUndecided(state);", "return;");
  setenv("GPU_PLANNING_SCENE_SHADERS", shaders.path().c_str(), 1);
  for (const std::string part : {"latency", "build", "updates", "growth"})
  {
    const ProgramOutput output =
        runBenchmark(folder.path(), {"--parts", part, "--scenes", "arm_boxes", "--methods", "ours_work_queue"});
    EXPECT_EQ(output.exit_code, 1) << part;
    EXPECT_NE(output.err.find("wrong answers of methods that claim to be exact"), std::string::npos) << output.err;
  }
  unsetenv("GPU_PLANNING_SCENE_SHADERS");
}

TEST(Benchmark, WritesEveryTableAndTheChartsAreDrawn)
{
  const TemporaryFolder folder;
  const ProgramOutput output = runBenchmark(folder.path(), {"--scenes", "arm_boxes", "--kinds", "random", "--methods",
                                                            "exact_cpu,ours_work_queue,fcl_obbrss,spheres_4"});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const std::map<std::string, std::vector<std::string>> expected = {
      {"run", {"what", "value"}},
      {"throughput", {"scene", "kind", "padding_m", "method", "batch", "states_per_s", "cpu_us_a_state"}},
      {"accuracy", {"scene", "kind", "method", "batch", "wrong_per_million", "largest_error_m"}},
      {"stages", {"scene", "stage", "decided_share", "ns_a_state"}},
      {"kernels", {"scene", "method", "batch", "command", "calls_a_batch", "us_a_batch", "mean_us", "longest_us"}},
      {"latency", {"scene", "method", "batch", "p50_us", "p99_us", "of_fcl_obbrss"}},
      {"build", {"scene", "method", "load_robot_s", "build_s", "update_s", "peak_host_mib", "device_mib"}},
      {"updates", {"robot", "objects", "method", "updates", "p50_ms", "p99_ms"}},
      {"growth", {"with", "amount", "method", "us_a_state", "build_s", "update_s", "valid_share"}},
      {"mesh_pairs", {"triangles", "distance_m", "method", "us_a_pose", "wrong"}},
      {"required_distances", {"size_m", "required_m", "p50_us", "steps_a_pose", "of_no_distance"}}};
  for (const auto& [name, columns] : expected)
  {
    const Table table = readTable(folder.path() + "/" + name + ".csv");
    ASSERT_FALSE(table.empty()) << name;
    for (const std::string& column : columns)
      EXPECT_EQ(table.front().count(column), 1U) << name << ": " << column;
  }

  std::map<std::string, double> calls;
  for (const Row& row : readTable(folder.path() + "/kernels.csv"))
    calls[row.at("command")] += std::stod(row.at("calls_a_batch"));
  EXPECT_GE(calls["traversal/work_queue.comp"], 2.0) << "passes of a part";
  for (const char* once_a_part : {"broad_phase/root_pairs.comp", "common/batch_done.comp", "upload", "readback"})
    EXPECT_GE(calls[once_a_part], 1.0) << once_a_part;

  const ProgramOutput charts = runProgram("/usr/bin/python3", {"-B", GPS_CHARTS, folder.path()});
  if (charts.err.find("No module named 'matplotlib'") != std::string::npos)
    GTEST_SKIP() << "there is no matplotlib";
  ASSERT_EQ(charts.exit_code, 0) << charts.err;
  for (const char* name : {"speed_accuracy_random", "throughput", "growth", "latency", "mesh_pairs"})
  {
    std::ostringstream svg;
    svg << std::ifstream(folder.path() + "/" + name + ".svg").rdbuf();
    EXPECT_GT(svg.str().size(), 5000U) << name;
    EXPECT_NE(svg.str().find("ours, work queues"), std::string::npos) << name;
  }
}

TEST(Benchmark, NamesTheFolderWithoutTheRobot)
{
  const TemporaryFolder folder;
  const ProgramOutput named = runBenchmark(folder.path(), {"--data", folder.path(), "--scenes", "kr5"});
  EXPECT_EQ(named.exit_code, 1);
  EXPECT_NE(named.err.find(folder.path() + "/urdf/KR5"), std::string::npos) << named.err;
  EXPECT_NE(named.err.find("--data"), std::string::npos) << named.err;

  const ProgramOutput missing = runBenchmark(folder.path(), {"--data", folder.path() + "/none"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find(folder.path() + "/none"), std::string::npos) << missing.err;
}

TEST(Benchmark, RunsWithoutAnyRobotOfOthers)
{
  const TemporaryFolder folder;
  const ProgramOutput output = runBenchmark(
      folder.path(), {"--data", folder.path(), "--parts", "throughput", "--kinds", "random", "--methods", "exact_cpu"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_NE(output.err.find("kr5_boxes is left out"), std::string::npos) << output.err;
  EXPECT_EQ(readTable(folder.path() + "/throughput.csv").size(), 2U);
}

// The realigned DOP of a large wall triangle is much larger than the triangle. If the wall were the mesh that moves, a
// state would take thousands of tests.
TEST(Benchmark, DopTreesRealignTheLinksAndNotTheWorld)
{
  if (!missingFor("ur5_cage").empty())
    GTEST_SKIP() << "there is no " << missingFor("ur5_cage");
  const TemporaryFolder folder;
  const ProgramOutput output = runBenchmark(folder.path(), {"--parts", "throughput", "--scenes", "ur5_cage", "--kinds",
                                                            "random", "--methods", "rapid,dop18,dop18_larger,dop24"});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const Table table = readTable(folder.path() + "/throughput.csv");
  ASSERT_EQ(table.size(), 4U);
  for (const Row& row : table)
  {
    EXPECT_GE(number(row, "node_visits_a_state"), number(row, "root_pairs_a_state")) << row.at("method");
    EXPECT_LT(number(row, "node_visits_a_state"), 1000.0) << row.at("method");
  }
}

TEST(Benchmark, MeasuresVampInScenesOfTheUr5AndLeavesItOutElsewhere)
{
  if (!benchmark::whyNoVamp().empty())
    GTEST_SKIP() << benchmark::whyNoVamp();
  if (!missingFor("ur5_cage").empty())
    GTEST_SKIP() << "there is no " << missingFor("ur5_cage");
  const TemporaryFolder folder;
  // Without other methods, only the scene ur5_cage without padding is measured.
  const ProgramOutput output =
      runBenchmark(folder.path(), {"--parts", "throughput", "--scenes", "ur5_cage,arm_boxes", "--kinds", "random",
                                   "--padding", "0,0.01", "--methods", "vamp"});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  EXPECT_NE(output.err.find("arm_boxes: vamp is left out: VAMP's check is generated for one robot"), std::string::npos)
      << output.err;
  for (const char* name : {"throughput", "accuracy"})
  {
    const Table table = readTable(folder.path() + "/" + name + ".csv");
    ASSERT_EQ(table.size(), 1U) << name;
    EXPECT_EQ(table.front().at("method"), "vamp");
    EXPECT_EQ(table.front().at("scene"), "ur5_cage");
    EXPECT_EQ(table.front().at("padding_m"), "0");
  }
}

TEST(Benchmark, SaysWhyThereIsNoVamp)
{
  if (benchmark::whyNoVamp().empty())
    GTEST_SKIP() << "VAMP can be used here";
  const ProgramOutput named = runProgram(GPS_BENCHMARK, {"--methods", "vamp"});
  EXPECT_EQ(named.exit_code, 1);
  EXPECT_NE(named.err.find("--methods: there is no vamp here: " + benchmark::whyNoVamp()), std::string::npos)
      << named.err;
}

TEST(Benchmark, AnUnknownNamePrintsTheList)
{
  const ProgramOutput scene = runProgram(GPS_BENCHMARK, {"--scenes", "mars"});
  EXPECT_EQ(scene.exit_code, 2);
  EXPECT_NE(scene.err.find("ur5_cage"), std::string::npos) << scene.err;
  const ProgramOutput method = runProgram(GPS_BENCHMARK, {"--methods", "oracle"});
  EXPECT_EQ(method.exit_code, 2);
  EXPECT_NE(method.err.find("ours_breadth_first"), std::string::npos) << method.err;
  const ProgramOutput padding = runProgram(GPS_BENCHMARK, {"--padding", "-1"});
  EXPECT_EQ(padding.exit_code, 2);
}
}  // namespace gpu_planning_scene::core
