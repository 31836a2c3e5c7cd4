// Runs the tool check_states and tests its answers, its summary and its exit codes.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "model/model_testing.h"
#include "scene/slider_robot.h"
#include "support/shader_folder.h"
#include "support/xacro_stand_in.h"
#include "tools/run_program.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A wall from x = 0.9 to 1.1 m, which the cart can hit, and a lamp at x = -1 m at the height of the pole.
const char* const kScene = R"(
world:
  collision_objects:
    - id: wall
      primitives: [{type: box, dimensions: [0.2, 1, 0.2]}]
      primitive_poses: [{position: [1, 0, 0]}]
    - id: "lamp, red"
      primitives: [{type: sphere, dimensions: [0.1]}]
      primitive_poses: [{position: [-1, 0, 0.5]}]
)";
const char* const kState = "robot_state: {joint_state: {name: [slide, turn], position: [0, 0]}}\n";

class CheckStates : public testing::Test
{
 public:
  CheckStates()
  {
    urdf = folder.write("slider.urdf", sliderUrdf());
    srdf = folder.write("slider.srdf", sliderSrdf());
    scene = folder.write("scene.yaml", std::string(kScene) + kState);
  }

  ProgramOutput run(std::vector<std::string> arguments) const
  {
    if (std::find(arguments.begin(), arguments.end(), "--device") == arguments.end())
      arguments.insert(arguments.end(), {"--device", "cpu"});
    return runProgram(GPS_CHECK_STATES, arguments);
  }

  /// Runs the tool with the slider robot and the scene.
  ProgramOutput check(std::vector<std::string> arguments) const
  {
    arguments.insert(arguments.begin(), {"--urdf", urdf, "--srdf", srdf, "--scene", scene});
    return run(std::move(arguments));
  }

  ProgramOutput checkCsv(const std::string& csv, std::vector<std::string> arguments = {}) const
  {
    arguments.insert(arguments.end(), {"--states", folder.write("states.csv", csv)});
    return check(std::move(arguments));
  }

  /// Expects one clear line on stderr and nothing on stdout.
  static void expectError(const ProgramOutput& output, int exit_code, const std::string& reason)
  {
    EXPECT_EQ(exit_code, output.exit_code);
    EXPECT_EQ("", output.out);
    EXPECT_EQ(1u, linesOf(output.err).size()) << output.err;
    EXPECT_EQ(0u, output.err.find("check_states: ")) << output.err;
    EXPECT_NE(std::string::npos, output.err.find(reason)) << output.err;
  }

  /// The answers without their header, one line per state.
  static std::vector<std::string> rowsOf(const ProgramOutput& output)
  {
    std::vector<std::string> lines = linesOf(output.out);
    if (lines.empty() || lines.front() != "valid,body_1,body_2")
      throw std::runtime_error("no header: " + output.out + output.err);
    lines.erase(lines.begin());
    return lines;
  }

  TemporaryFolder folder;
  std::string urdf;
  std::string srdf;
  std::string scene;
};

TEST_F(CheckStates, AnswersARowForEachState)
{
  const std::string csv = "slide,turn\n0,0\n0.75,1\n0.85,1\n-1.1,0\n";
  const ProgramOutput output = checkCsv(csv);
  EXPECT_EQ(0, output.exit_code);
  EXPECT_EQ(output.out, checkCsv(csv, {"--max-batch", "3"}).out);
  const auto rows = rowsOf(output);
  ASSERT_EQ(4u, rows.size());
  EXPECT_EQ("1,,", rows[0]);
  EXPECT_EQ("1,,", rows[1]);
  EXPECT_TRUE(rows[2] == "0,cart,wall" || rows[2] == "0,wall,cart") << rows[2];
  EXPECT_TRUE(rows[3] == "0,pole,\"lamp, red\"" || rows[3] == "0,\"lamp, red\",pole") << rows[3];
}

TEST_F(CheckStates, ColumnsMayComeInAnyOrderAndForm)
{
  const auto rows = rowsOf(checkCsv("\xEF\xBB\xBF\"turn\" , slide\r\n 0.5,\"0\"\r\n0.5 , 1e0\r\n1,+0.5\r\n\r\n"));
  ASSERT_EQ(3u, rows.size());
  EXPECT_EQ('1', rows[0][0]);
  EXPECT_EQ('0', rows[1][0]);
  EXPECT_EQ('1', rows[2][0]);
}

TEST_F(CheckStates, OtherVariablesTakeTheScenesState)
{
  EXPECT_EQ("1,,", rowsOf(checkCsv("turn\n0.5\n")).at(0));
  scene = folder.write("scene.yaml",
                       std::string(kScene) + "robot_state: {joint_state: {name: [slide, turn], position: [1, 0]}}");
  EXPECT_EQ('0', rowsOf(checkCsv("turn\n0.5\n")).at(0).at(0));
  scene = folder.write("scene.yaml", kScene);
  expectError(checkCsv("turn\n0.5\n"), 1, "states.csv:1: no value for slide");
}

TEST_F(CheckStates, AGroupRestrictsThePairs)
{
  // In the first state the cart is in the wall, in the second state the pole is in the lamp.
  const std::string csv = "slide,turn\n1,0\n-1,0\n";
  EXPECT_EQ('0', rowsOf(checkCsv(csv)).at(0).at(0));
  const auto rows = rowsOf(checkCsv(csv, {"--group", "mast"}));
  EXPECT_EQ("1,,", rows.at(0));
  EXPECT_EQ('0', rows.at(1).at(0));
  expectError(checkCsv(csv, {"--group", "sails"}), 1, "sails");
}

TEST_F(CheckStates, FewStatesHaveNoRate)
{
  const std::string few = linesOf(check({"--random", "99"}).err).back();
  EXPECT_EQ("99 states", few.substr(0, 9));
  EXPECT_EQ(std::string::npos, few.find("states/s"));
  EXPECT_NE(std::string::npos, linesOf(check({"--random", "100"}).err).back().find(" states/s, "));
}

TEST_F(CheckStates, ManyAnswersAreNotPrintedToATerminal)
{
  const auto on_terminal = [this](const std::string& count)
  {
    return runOnTerminal(GPS_CHECK_STATES,
                         {"--urdf", urdf, "--srdf", srdf, "--scene", scene, "--device", "cpu", "--random", count});
  };
  const ProgramOutput many = on_terminal("31");
  EXPECT_EQ(0, many.exit_code) << many.err;
  EXPECT_EQ("", many.out);
  EXPECT_NE(std::string::npos, many.err.find("answers: 31 rows, not printed to the terminal; give --out FILE"))
      << many.err;
  EXPECT_EQ("31 states", linesOf(many.err).back().substr(0, 9));
  EXPECT_EQ(31u, linesOf(on_terminal("30").out).size());
}

TEST_F(CheckStates, TheLastLineOfTheSummaryIsAsPromised)
{
  const ProgramOutput output = check({"--random", "3000", "--seed", "7", "--max-batch", "999"});
  EXPECT_EQ(0, output.exit_code);
  const auto rows = rowsOf(output);
  ASSERT_EQ(3000u, rows.size());
  const auto valid = std::count(rows.begin(), rows.end(), "1,,");
  const std::string last = linesOf(output.err).back();
  unsigned long states = 0, free = 0, rate = 0;
  ASSERT_EQ(3, std::sscanf(last.c_str(), "%lu states, %lu valid, %lu states/s, CPU", &states, &free, &rate)) << last;
  EXPECT_EQ(std::to_string(states) + " states, " + std::to_string(free) + " valid, " + std::to_string(rate) +
                " states/s, CPU",
            last);
  EXPECT_EQ(3000u, states);
  EXPECT_EQ(static_cast<unsigned long>(valid), free);
  EXPECT_GT(rate, 0u);
  const std::string share = "\nvalid: " + std::to_string(valid) + " of 3000 states (";
  for (const char* part : {"device: CPU", "robot: slider", "triangles: ", "checked pairs of bodies: ", "left out: ",
                           share.c_str(), "states in collision, by the pair that was found first:"})
    EXPECT_NE(std::string::npos, output.err.find(part)) << output.err;
}

TEST_F(CheckStates, AXacroFileIsExpandedWhereXacroIsInstalled)
{
  const std::string raw = folder.write("slider.urdf.xacro", std::regex_replace(sliderUrdf(), std::regex("<robot[^>]*>"),
                                                                               "$&<xacro:include filename='x'/>"));
  const std::vector<std::string> arguments = {"--urdf", raw, "--srdf", srdf, "--state", "left", "--device", "cpu"};
  {
    const XacroStandIn xacro(kExpandingXacro);
    const ProgramOutput output = run(arguments);
    EXPECT_EQ(0, output.exit_code) << output.err;
    EXPECT_NE(std::string::npos,
              output.err.find("URDF '" + raw + "' is a xacro file: it was expanded with its default arguments by " +
                              xacro.program() + "\n"))
        << output.err;
  }
  {
    const XacroStandIn xacro("echo 'cannot find x' >&2; exit 1");
    expectError(run(arguments), 1, "failed with exit code 1: cannot find x");
  }
  const PathVariable without_xacro(folder.path(""));
  expectError(run(arguments), 1, "is xacro, which must be expanded first: xacro '" + raw + "' > expanded.urdf");
}

TEST_F(CheckStates, TheCountsOfPairsSumUpToTheStatesInCollision)
{
  const ProgramOutput output = check({"--random", "3000", "--seed", "7"});
  const auto lines = linesOf(output.err);
  auto line = std::find(lines.begin(), lines.end(), "states in collision, by the pair that was found first:");
  ASSERT_NE(lines.end(), line) << output.err;
  unsigned long sum = 0;
  for (++line; line != lines.end() && line->compare(0, 2, "  ") == 0; ++line)
    sum += std::stoul(line->substr(line->find(": ") + 2));
  const auto rows = rowsOf(output);
  EXPECT_EQ(3000 - std::count(rows.begin(), rows.end(), "1,,"), sum);
}

TEST_F(CheckStates, RandomStatesAreTheModelsAndDependOnTheSeedAlone)
{
  const auto robot = RobotModel::fromFiles(urdf, srdf, {});
  std::mt19937_64 generator(7);
  std::vector<double> states(500 * robot->variables().size());
  for (std::size_t i = 0; i < 500; ++i)
    robot->randomState(generator, states.data() + i * robot->variables().size());
  CpuChecker checker(std::make_shared<const PlanningScene>(loadSceneFile(scene, robot, {})));
  const BatchResult expected = checker.check(states.data(), 500);

  const ProgramOutput output = check({"--random", "500", "--seed", "7"});
  const std::string one_batch = output.out;
  const auto rows = rowsOf(output);
  ASSERT_EQ(500u, rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_EQ(expected.valid[i], rows[i][0] - '0') << "state " << i;
  EXPECT_EQ(one_batch, check({"--random", "500", "--seed", "7", "--max-batch", "33"}).out);
  EXPECT_NE(one_batch, check({"--random", "500", "--seed", "8"}).out);
}

TEST_F(CheckStates, WarnsOfAMatrixThatLosesPairsOfTheSrdf)
{
  std::string longer_pole = sliderUrdf();
  const std::string size = "0.1 0.1 0.4";
  longer_pole.replace(longer_pole.find(size), size.size(), "0.1 0.1 1.2");  // it goes through the cart
  urdf = folder.write("slider.urdf", longer_pole);
  scene = folder.write("scene.yaml",
                       "allowed_collision_matrix: {entry_names: [nut, rail], entry_values: [[0, 1], [1, 0]]}\n");
  const ProgramOutput lost = check({"--random", "10"});
  EXPECT_EQ(0, lost.exit_code);
  EXPECT_NE(std::string::npos, lost.err.find("warning: 1 pair in collision in each of 64 random states, so probably no "
                                             "state is valid: cart - pole; the SRDF allows them"))
      << lost.err;
  EXPECT_NE(std::string::npos, lost.err.find("use allowed_collisions, which adds pairs")) << lost.err;
  scene = folder.write("scene.yaml", "allowed_collisions: [[nut, rail]]\n");
  const ProgramOutput kept = check({"--random", "10"});
  EXPECT_EQ(std::string::npos, kept.err.find("warning")) << kept.err;
  EXPECT_NE(std::string::npos, kept.err.find("10 states, 10 valid")) << kept.err;
}

TEST_F(CheckStates, WarnsOnceOfValuesOutsideTheLimits)
{
  const ProgramOutput output = checkCsv("slide,turn\n0,0\n0,90\n0,45\n");
  EXPECT_EQ(0, output.exit_code);
  EXPECT_EQ(3u, rowsOf(output).size());
  EXPECT_EQ(0u, output.err.find("warning: " + folder.path("states.csv") +
                                ":3: joint 'turn' is 90, outside its limits -3 to 3 rad; values are in radians, and 90 "
                                "degrees are 1.5708 rad; 1 more value is outside the limits\n"))
      << output.err;
  EXPECT_EQ(output.err.find("warning"), output.err.rfind("warning")) << output.err;
  EXPECT_EQ(std::string::npos, check({"--random", "10"}).err.find("warning"));
}

TEST_F(CheckStates, BlamesTheSceneFileForTheSceneFilesValues)
{
  scene = folder.write("scene.yaml",
                       std::string(kScene) + "robot_state: {joint_state: {name: [slide, turn], position: [0, 90]}}");
  const std::string errors = check({"--state", "slide=0"}).err;
  EXPECT_NE(std::string::npos, errors.find("robot_state: joint 'turn' is 90")) << errors;
  EXPECT_EQ(std::string::npos, errors.find("--state: joint")) << errors;
}

TEST_F(CheckStates, SavedStatesHaveTheSameAnswers)
{
  const std::string path = folder.path("saved.csv");
  const ProgramOutput random = check({"--random", "50", "--seed", "3", "--save-states", path});
  EXPECT_EQ(0, random.exit_code) << random.err;
  EXPECT_EQ(random.out, check({"--states", path}).out);
}

TEST_F(CheckStates, WritesToAFileWhereAsked)
{
  const std::string path = folder.write("answers.csv", "something older\nthat is longer than the answers are\n");
  const ProgramOutput output = checkCsv("slide,turn\n0,0\n", {"--out", path});
  EXPECT_EQ("", output.out);
  std::ifstream file(path);
  EXPECT_EQ("valid,body_1,body_2\n1,,\n", std::string(std::istreambuf_iterator<char>(file), {}));
}

TEST_F(CheckStates, AFailureLeavesTheOutputFileAsItWas)
{
  const std::string path = folder.write("answers.csv", "kept");
  EXPECT_EQ(1, checkCsv("slide,turn\n0,x\n", {"--out", path}).exit_code);
  std::ifstream file(path);
  EXPECT_EQ("kept", std::string(std::istreambuf_iterator<char>(file), {}));
  expectError(checkCsv("slide,turn\n0,0\n", {"--out", folder.path("no/such/folder.csv")}), 1, "cannot write");
}

TEST_F(CheckStates, ASceneIsNotNeeded)
{
  const ProgramOutput output = run({"--urdf", urdf, "--random", "10"});
  EXPECT_EQ(0, output.exit_code) << output.err;
  EXPECT_NE(std::string::npos, output.err.find("adjacent (no SRDF was given)")) << output.err;
}

TEST_F(CheckStates, EveryDeviceAndTraversalAnswersTheSame)
{
  const auto valid = [](const ProgramOutput& output)
  {
    std::string column;
    for (const std::string& row : rowsOf(output))
      column += row[0];
    return column;
  };
  const std::string expected = valid(check({"--random", "2000", "--device", "cpu"}));
  for (const char* traversal : {"breadth_first", "work_queue"})
  {
    const ProgramOutput output = check(
        {"--random", "2000", "--max-batch", "300", "--device", "software", "--device-only", "--traversal", traversal});
    if (output.err.find("no usable EGL device") != std::string::npos)
      GTEST_SKIP() << output.err;
    EXPECT_EQ(expected, valid(output)) << traversal << ": " << output.err;
  }
}

TEST_F(CheckStates, TheLastLineSaysWhoCheckedTheStates)
{
  const auto last_word = [this](const std::vector<std::string>& arguments)
  {
    const ProgramOutput output = check(arguments);
    const std::string last = linesOf(output.err).back();
    return last.substr(last.rfind(", ") + 2);
  };
  if (const ProgramOutput output = check({"--random", "1", "--device", "software"});
      output.err.find("no usable EGL device") != std::string::npos)
    GTEST_SKIP() << output.err;
  EXPECT_EQ("CPU", last_word({"--random", "1"}));
  EXPECT_NE("CPU", last_word({"--random", "1", "--device", "software"}));
  EXPECT_NE("CPU", last_word({"--random", "1", "--device", "auto", "--device-only"}));
}

TEST_F(CheckStates, WithoutADeviceTheCpuAnswersUnlessOneIsNamed)
{
  setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null", 1);  // as if no driver were installed
  const ProgramOutput replaced = check({"--random", "50", "--device", "auto"});
  const ProgramOutput refused = check({"--random", "50", "--device", "software"});
  unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
  EXPECT_EQ(replaced.exit_code, 0) << replaced.err;
  EXPECT_NE(replaced.err.find("warning: no device can be used, so the CPU checks the states: no usable EGL device"),
            std::string::npos)
      << replaced.err;
  EXPECT_EQ(replaced.out, check({"--random", "50", "--device", "cpu"}).out);
  expectError(refused, 1, "no usable EGL device");
  EXPECT_NE(std::string::npos, refused.err.find("install")) << refused.err;
  EXPECT_NE(std::string::npos, refused.err.find("'cpu'")) << refused.err;
}

TEST_F(CheckStates, ADeviceThatBuildsWrongTreesIsReplacedByTheCpuUnlessItWasNamed)
{
  const ShaderFolder shaders;
  shaders.replace("tree_build/layout.glsl", "primitive_base + c.reference;", "primitive_base;");
  setenv("GPU_PLANNING_SCENE_SHADERS", shaders.path().c_str(), 1);
  const ProgramOutput replaced = check({"--random", "500", "--device", "auto", "--device-only"});
  const ProgramOutput refused = check({"--random", "500", "--device", "0"});
  unsetenv("GPU_PLANNING_SCENE_SHADERS");
  if (replaced.err.find("no usable EGL device") != std::string::npos)
    GTEST_SKIP() << replaced.err;
  EXPECT_EQ(replaced.exit_code, 0) << replaced.err;
  EXPECT_NE(
      replaced.err.find("warning: no device can be used, so the CPU checks the states: the GPU built wrong trees"),
      std::string::npos)
      << replaced.err;
  EXPECT_EQ(replaced.out, check({"--random", "500"}).out);
  expectError(refused, 1, "the GPU built wrong trees");
  EXPECT_EQ(refused.out, "");
}

TEST_F(CheckStates, SaysWhatItIsAndCanDo)
{
  const ProgramOutput version = run({"--version"});
  EXPECT_EQ(0, version.exit_code);
  int major = 0, minor = 0, patch = 0;
  EXPECT_EQ(3, std::sscanf(version.out.c_str(), "check_states %d.%d.%d\n", &major, &minor, &patch)) << version.out;
  const ProgramOutput help = run({"--help"});
  EXPECT_EQ(0, help.exit_code);
  for (const char* option :
       {"--urdf", "--srdf", "--package", "--planning", "--scene", "--states", "--state", "--random", "--random-base",
        "--seed", "--group", "valid,body_1,body_2", "--device", "--traversal", "--out", "--version", "--help"})
    EXPECT_NE(std::string::npos, help.out.find(option)) << option;
}

TEST_F(CheckStates, RandomStatesLeaveABaseWhereItIsUnlessAsked)
{
  // The rail's base is at x = 100 m in the scene, so the cart never comes to the wall. At the origin, it often does.
  srdf = folder.write("floor.srdf",
                      "<robot name=\"slider\"><virtual_joint name=\"floor\" type=\"planar\" "
                      "parent_frame=\"hall\" child_link=\"rail\"/></robot>");
  scene = folder.write("far.yaml", std::string(kScene) +
                                       "robot_state: {joint_state: {name: [floor/x, slide], "
                                       "position: [100, 0]}}");
  const auto colliding = [](const ProgramOutput& output)
  {
    const auto rows = rowsOf(output);
    return std::count_if(rows.begin(), rows.end(), [](const std::string& row) { return row[0] == '0'; });
  };
  EXPECT_EQ(0, colliding(check({"--random", "500"})));
  EXPECT_LT(0, colliding(check({"--random", "500", "--random-base"})));
}

TEST_F(CheckStates, AStateIsGivenByVariablesAndByNamesOfTheSrdf)
{
  std::string text = sliderSrdf();
  text.insert(text.find("</robot>"),
              "<group_state name=\"in_wall\" group=\"drive\"><joint name=\"slide\" value=\"1\"/>"
              "<joint name=\"turn\" value=\"0\"/></group_state>");
  srdf = folder.write("named.srdf", text);
  EXPECT_EQ('0', rowsOf(check({"--state", "in_wall"})).at(0).at(0));
  EXPECT_EQ('0', rowsOf(check({"--state", "drive/in_wall"})).at(0).at(0));
  EXPECT_EQ('0', rowsOf(check({"--state", "slide=1"})).at(0).at(0));
  EXPECT_EQ("1,,", rowsOf(check({"--state", "in_wall,slide=0"})).at(0));
  expectError(check({"--state", "ready"}), 2,
              "--state: 'ready': the SRDF has no state 'ready'; its states: drive/left, drive/right, drive/in_wall");
  expectError(check({"--state", "joint1=1"}), 2,
              "--state: 'joint1=1': the robot has no variable 'joint1'; the robot's variables are slide, turn");
  expectError(check({"--state", "slide=x"}), 2, "--state: 'x' is not a finite number");
  EXPECT_NE(std::string::npos, check({"--state", "turn=90"}).err.find("warning: --state: joint 'turn' is 90, outside"));
}

TEST_F(CheckStates, PackagesAreFoundOnRosPackagePathOrByOption)
{
  std::string text = sliderUrdf();
  const std::string box = "<box size=\"0.2 0.2 0.2\"/>";
  text.replace(text.find(box), box.size(), "<mesh filename=\"package://carts/cart.obj\"/>");
  urdf = folder.write("mesh.urdf", text);
  std::filesystem::create_directories(folder.path("ws/nested"));
  folder.write("ws/nested/cart.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\n");
  folder.write("ws/nested/package.xml", "<package format=\"2\"><name>carts</name></package>");
  setenv("ROS_PACKAGE_PATH", (folder.path("none") + ":" + folder.path("ws")).c_str(), 1);
  const ProgramOutput found = check({"--random", "1"});
  setenv("ROS_PACKAGE_PATH", folder.path("none").c_str(), 1);
  const ProgramOutput lost = check({"--random", "1"});
  const ProgramOutput named = check({"--random", "1", "--package", "carts=" + folder.path("ws/nested")});
  unsetenv("ROS_PACKAGE_PATH");
  EXPECT_EQ(0, found.exit_code) << found.err;
  EXPECT_EQ(0, named.exit_code) << named.err;
  expectError(lost, 1,
              "the folder of package 'carts' is not known; put the package on ROS_PACKAGE_PATH, or name its "
              "folder (--package carts=DIR)");
}

TEST_F(CheckStates, AnObjectMayLieInAPackage)
{
  folder.write("plate.obj", "v 1 -1 0\nv 1 1 0\nv 1 0 1\nf 1 2 3\n");
  const ProgramOutput output = check({"--object", "plate=package://parts/plate.obj", "--package",
                                      "parts=" + folder.path("."), "--state", "slide=1.1"});
  EXPECT_EQ(0, output.exit_code) << output.err;
  EXPECT_NE(std::string::npos, output.err.find("scene: 3 objects")) << output.err;
}

TEST_F(CheckStates, BadUsageEndsWithTwo)
{
  const std::string csv = folder.write("states.csv", "slide,turn\n0,0\n");
  expectError(run({}), 2, "--urdf is missing");
  expectError(check({}), 2, "give one of --states FILE, --state ITEM,... and --random N");
  expectError(check({"--states", csv, "--random", "1"}), 2,
              "give one of --states FILE, --state ITEM,... and --random N");
  expectError(check({"--states", csv, "--seed", "1"}), 2, "--seed needs --random");
  expectError(check({"--state", "turn=0", "--random-base"}), 2, "--random-base needs --random");
  expectError(check({"--state", "turn=0,turn=1"}), 2, "--state: 'turn=1': variable 'turn' is given twice");
  expectError(check({"--random", "0"}), 2, "--random: '0'");
  expectError(check({"--group", "mast", "--state", "slide=0"}), 2, "--state: the state sets no variable of the group");
  expectError(check({"--random", "ten"}), 2, "--random: 'ten'");
  expectError(check({"--random", "1.5"}), 2, "--random: '1.5'");
  expectError(check({"--random", "1", "--seed", "-1"}), 2, "--seed: '-1'");
  expectError(check({"--random", "1", "--fast"}), 2, "unknown option '--fast'");
  expectError(check({"--random", "1", "more"}), 2, "unexpected argument 'more'");
  expectError(check({"--random", "1", "--random", "2"}), 2, "--random is given twice");
  expectError(check({"--random", "1", "--package", "nothing"}), 2, "'nothing' is not NAME=DIR");
  expectError(check({"--random", "1", "--traversal", "depth_first"}), 2, "depth_first");
  expectError(check({"--random", "1", "--max-batch", "0"}), 2, "--max-batch");
  expectError(runProgram(GPS_CHECK_STATES, {"--urdf"}), 2, "--urdf needs a value");
  expectError(run({"--version=1"}), 2, "--version takes no value");
}

TEST_F(CheckStates, BadInputEndsWithOne)
{
  expectError(run({"--urdf", folder.path("no.urdf"), "--random", "1"}), 1, "no.urdf");
  expectError(run({"--urdf", folder.write("bad.urdf", "<robot"), "--random", "1"}), 1, "bad.urdf");
  expectError(run({"--urdf", urdf, "--scene", folder.path("no.yaml"), "--random", "1"}), 1, "no.yaml");
  expectError(check({"--states", folder.path("no.csv")}), 1, "no.csv: cannot read the file: No such file");
  expectError(checkCsv(""), 1, "states.csv: the file is empty");
  expectError(checkCsv("slide,turn\n"), 1, "no states");
  expectError(checkCsv("0,0\n1,1\n"), 1, "states.csv:1: column 1: the first line must name the variables");
  expectError(checkCsv("slide,trun\n0,0\n"), 1, "no variable 'trun'; the robot's variables are slide, turn");
  expectError(checkCsv("slide,turn,flag\n0,0,0\n"), 1,
              "joint 'flag' mimics joint 'turn', from which its value follows; leave it out");
  expectError(checkCsv("slide,turn,bolt\n0,0,0\n"), 1, "joint 'bolt' is fixed");
  expectError(checkCsv("slide,turn,slide\n0,0,0\n"), 1, "'slide' is given twice");
  expectError(checkCsv("slide,turn\n0,0\n0\n"), 1, "states.csv:3: 1 values for 2 variables");
  expectError(checkCsv("slide,turn\n0,0\n0,1,2\n"), 1, "states.csv:3: 3 values for 2 variables");
  expectError(checkCsv("slide,turn\n0,0\n0,one\n"), 1, "states.csv:3: column 2 (turn): 'one'");
  expectError(checkCsv("slide,turn\n0,\n"), 1, "states.csv:2: column 2 (turn): ''");
  expectError(checkCsv("slide,turn\nnan,0\n"), 1, "states.csv:2: column 1 (slide): 'nan'");
  expectError(checkCsv("slide,turn\n0,-inf\n"), 1, "states.csv:2: column 2 (turn): '-inf'");
  expectError(checkCsv("slide,turn\n0,0\n\n0,0\n"), 1, "states.csv:3: an empty line");
  expectError(checkCsv("slide,turn\n\"0,0\n"), 1, "states.csv:2: a quotation mark");
  expectError(check({"--random", "1", "--device", "no such renderer"}), 1, "no such renderer");
}

TEST_F(CheckStates, NamesTheMeshesThatAreOnlySurfacesAndTakesRulesForThem)
{
  // A ball of 0.1 m in a cube of 2 m that lacks a side.
  const std::string mesh = folder.write("bin.obj",
                                        "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\n"
                                        "v 1 1 1\nv -1 1 1\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\n"
                                        "f 1 5 8 4\n");
  const std::string robot =
      folder.write("ball.urdf", "<robot name='ball'><link name='bin'><collision><geometry><mesh filename='" + mesh +
                                    "'/></geometry></collision></link><link name='ball'><collision><geometry>"
                                    "<sphere radius='0.1'/></geometry></collision></link>" +
                                    jointXml("slide", "prismatic", "bin", "ball", kLimits) + "</robot>");
  const std::vector<std::string> arguments = {
      "--urdf", robot, "--srdf", folder.write("b.srdf", "<robot name='ball'/>"), "--state", "slide=0", "--solid"};
  const auto with_rule = [&](const std::string& rule)
  {
    std::vector<std::string> all = arguments;
    all.push_back(rule);
    return run(all);
  };
  const ProgramOutput open = with_rule("bin=auto");
  EXPECT_EQ("1,,", rowsOf(open).at(0));
  EXPECT_NE(std::string::npos, open.err.find("link 'bin', mesh '")) << open.err;
  EXPECT_NE(std::string::npos, open.err.find("is only a surface: 1 hole of up to 2.8 m (20 % of the area")) << open.err;
  const ProgramOutput filled = with_rule("bin=filled");
  EXPECT_EQ("0,bin,ball", rowsOf(filled).at(0));
  EXPECT_NE(std::string::npos, filled.err.find("1 hole of up to 2.8 m is filled (up to 20 % of")) << filled.err;
  expectError(with_rule("bin"), 2, "--solid: 'bin' is not LINK=RULE");
  expectError(with_rule("bin=full"), 2, "'full' is unknown; known are auto, surface and filled");
  expectError(with_rule("bean=filled"), 1, "solid of link 'bean': the robot has no such link");
}

TEST_F(CheckStates, RandomStatesAreWithinTheLimitsOfThePlanningFile)
{
  const std::string planning =
      folder.write("limits.yaml", "joint_limits: {slide: {min_position: 0.25, max_position: 0.3}}\n");
  const std::string states = folder.path("states.csv");
  const ProgramOutput output = check({"--planning", planning, "--random", "50", "--save-states", states});
  EXPECT_EQ(0, output.exit_code) << output.err;
  EXPECT_NE(std::string::npos, output.err.find("limits from " + planning + ": slide (0.25 to 0.3)\n")) << output.err;
  std::ifstream file(states);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ("slide,turn", line);
  int count = 0;
  for (; std::getline(file, line); ++count)
  {
    EXPECT_GE(std::stod(line), 0.25);
    EXPECT_LE(std::stod(line), 0.3);
  }
  EXPECT_EQ(50, count);

  const ProgramOutput outside = check({"--planning", planning, "--state", "slide=1"});
  EXPECT_NE(std::string::npos, outside.err.find("joint 'slide' is 1, outside its limits 0.25 to 0.3")) << outside.err;
  const ProgramOutput missing = check({"--planning", "/no/limits.yaml", "--random", "1"});
  EXPECT_EQ(1, missing.exit_code);
  EXPECT_NE(std::string::npos, missing.err.find("/no/limits.yaml")) << missing.err;
}
}  // namespace
}  // namespace gpu_planning_scene::core
