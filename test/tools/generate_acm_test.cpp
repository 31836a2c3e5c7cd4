// Runs the tool generate_acm and tests its decisions on pairs of links and the SRDF that it writes.

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "model/model_testing.h"
#include "support/xacro_stand_in.h"
#include "tools/run_program.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string boxes(const std::string& link, const std::vector<std::pair<double, double>>& spans)
{
  std::string xml = "<link name=\"" + link + "\">";
  for (const auto& [from, to] : spans)
    xml += "<collision><origin xyz=\"" + std::to_string(0.5 * (from + to)) + " 0 0\"/><geometry><box size=\"" +
           std::to_string(to - from) + " 0.1 0.1\"/></geometry></collision>";
  return xml + "</link>\n";
}

/// Boxes on a line, so that the right decision on each pair follows from arithmetic. The joint `slide` moves half,
/// cover, core and spare along x by -5 to 5 m; block and mount do not move. The block extends from x = -0.1 to 0.1. Its
/// relations to the other links: mount is adjacent; half (0.12 to 5) collides in about half of the states; cover, with
/// a gap of 0.3 m around the block, in 99 %; core in the default state, but seldom in others; sleeve, which is long, in
/// all states; spare, 100 m away, never.
std::string lineUrdf()
{
  const std::string range = "<axis xyz=\"1 0 0\"/><limit lower=\"-5\" upper=\"5\" effort=\"1\" velocity=\"1\"/>";
  return "<robot name=\"line--up\">" + boxes("block", {{-0.1, 0.1}}) + boxes("mount", {{-0.1, 0.1}}) +
         boxes("half", {{0.12, 5.0}}) + boxes("cover", {{-20.0, -0.15}, {0.15, 20.0}}) +
         boxes("core", {{-0.01, 0.01}}) + boxes("spare", {{100.0, 101.0}}) + boxes("sleeve", {{-20.0, 20.0}}) +
         jointXml("up", "fixed", "block", "mount", "<origin xyz=\"0 10 0\"/>") +
         jointXml("slide", "prismatic", "mount", "half", "<origin xyz=\"0 -10 0\"/>" + range) +
         jointXml("lid", "fixed", "half", "cover") + jointXml("pin", "fixed", "cover", "core") +
         jointXml("far", "fixed", "core", "spare") + jointXml("tube", "fixed", "spare", "sleeve") + "</robot>";
}

std::string contentOf(const std::string& path)
{
  std::ifstream file(path);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

std::map<std::string, std::string> reasonsOf(const RobotModel& robot)
{
  std::map<std::string, std::string> reasons;
  for (const LinkPair& pair : robot.srdfCollisions().disabled)
    reasons[robot.links()[pair.first].name + "-" + robot.links()[pair.second].name] = pair.reason;
  return reasons;
}

class GenerateAcm : public testing::Test
{
 public:
  GenerateAcm() : urdf(folder.write("line.urdf", lineUrdf())), out(folder.path("out.srdf")) {}

  ProgramOutput generate(std::vector<std::string> arguments) const
  {
    arguments.insert(arguments.end(), {"--urdf", urdf, "--out", out});
    return runProgram(GPS_GENERATE_ACM, arguments);
  }

  TemporaryFolder folder;
  std::string urdf;
  std::string out;
};

TEST_F(GenerateAcm, DecidesEachPairForTheRightReason)
{
  const ProgramOutput output = generate({"--samples", "2000", "--seed", "3"});
  ASSERT_EQ(0, output.exit_code) << output.err;
  const auto reasons = reasonsOf(*RobotModel::fromFiles(urdf, out, {}));
  const auto reason = [&](const std::string& pair) { return reasons.count(pair) ? reasons.at(pair) : "checked"; };
  EXPECT_EQ("Adjacent", reason("block-mount"));
  EXPECT_EQ("checked", reason("block-half"));
  EXPECT_EQ("Always", reason("block-cover"));
  EXPECT_EQ("Default", reason("block-sleeve"));
  EXPECT_EQ("checked", reason("block-core")) << "a real collision, which MoveIt's Setup Assistant disables";
  EXPECT_NE(std::string::npos, output.err.find("in the default state, 'block' and 'core' collide, but in many random"))
      << output.err;
  EXPECT_EQ("Never", reason("block-spare"));
  EXPECT_EQ("Never", reason("mount-cover"));
  EXPECT_EQ("Adjacent", reason("half-cover"));
}

TEST_F(GenerateAcm, TheShareOfAlwaysCanBeSet)
{
  ASSERT_EQ(0, generate({"--samples", "2000", "--always-share", "0.4"}).exit_code);
  EXPECT_EQ("Always", reasonsOf(*RobotModel::fromFiles(urdf, out, {})).at("block-half"));
}

TEST_F(GenerateAcm, TheCommentSaysWhatNeverMeans)
{
  ASSERT_EQ(0, generate({"--samples", "3000", "--seed", "42"}).exit_code);
  const std::string srdf = contentOf(out);
  EXPECT_NE(std::string::npos, srdf.find("3000 random states, seed 42")) << srdf;
  EXPECT_NE(std::string::npos, srdf.find("95 % confidence, for each pair, fewer than 0.1 % of random")) << srdf;
  // XML allows no two hyphens in a comment, but the robot's name contains them.
  const std::size_t comment = srdf.find("<!--") + 4;
  EXPECT_EQ(srdf.find("-->"), srdf.find("--", comment)) << srdf;
}

TEST_F(GenerateAcm, TheSameSeedWritesTheSameFile)
{
  ASSERT_EQ(0, generate({"--samples", "500", "--seed", "5"}).exit_code);
  const std::string first = contentOf(out);
  ASSERT_EQ(0, generate({"--samples", "500", "--seed", "5"}).exit_code);
  EXPECT_EQ(first, contentOf(out));
  EXPECT_EQ(first, runProgram(GPS_GENERATE_ACM, {"--urdf", urdf, "--samples", "500", "--seed", "5"}).out);
}

TEST_F(GenerateAcm, StartsFromTheExpandedTextOfAXacroFileAndDoesNotReplaceTheFile)
{
  const std::string text =
      "<robot name=\"line--up\"><xacro:include filename='x'/><group name=\"all\"><joint "
      "name=\"slide\"/></group></robot>";
  const std::string srdf = folder.write("users.srdf.xacro", text);
  const XacroStandIn xacro(kExpandingXacro);
  const ProgramOutput output = generate({"--samples", "100", "--srdf", srdf});
  ASSERT_EQ(0, output.exit_code) << output.err;
  EXPECT_NE(std::string::npos,
            output.err.find("SRDF '" + srdf + "' is a xacro file: it was expanded with its default arguments by "));
  EXPECT_EQ(std::string::npos, contentOf(out).find("xacro:"));
  EXPECT_EQ(1u, RobotModel::fromFiles(urdf, out, {})->groups().size());
  const ProgramOutput refused =
      runProgram(GPS_GENERATE_ACM, {"--urdf", urdf, "--samples", "100", "--srdf", srdf, "--out", srdf});
  EXPECT_EQ(1, refused.exit_code);
  EXPECT_NE(std::string::npos, refused.err.find("the expanded SRDF would replace it; give another file as --out"));
  EXPECT_EQ(text, contentOf(srdf));
  const auto other = std::filesystem::path(srdf).parent_path() / "." / "users.srdf.xacro";  // another name of the file
  EXPECT_EQ(1,
            runProgram(GPS_GENERATE_ACM, {"--urdf", urdf, "--samples", "100", "--srdf", srdf, "--out", other.string()})
                .exit_code);
  EXPECT_EQ(text, contentOf(srdf));
}

TEST_F(GenerateAcm, KeepsWhatTheUserWroteInAnSrdf)
{
  const std::string srdf = folder.write("users.srdf", R"(<robot name="line--up">
  <!-- my group -->
  <group name="all"><joint name="slide"/></group>
  <disable_collisions link1="block" link2="half" reason="User"/>
  <enable_collisions link1="block" link2="core"/>
  <disable_collisions link1="mount" link2="half" reason="Never"/>
  <disable_collisions link1="block" link2="half" reason="Never"/>
</robot>)");
  ASSERT_EQ(0, generate({"--samples", "1000", "--srdf", srdf}).exit_code);
  const std::string once = contentOf(out);
  EXPECT_NE(std::string::npos, once.find("<!-- my group -->"));
  const auto robot = RobotModel::fromFiles(urdf, out, {});
  EXPECT_EQ(1u, robot->groups().size());
  const auto reasons = reasonsOf(*robot);
  EXPECT_EQ("User", reasons.at("block-half"));
  EXPECT_EQ(0u, reasons.count("block-core"));
  EXPECT_EQ("Adjacent", reasons.at("mount-half"));

  // A second run replaces the tool's own entries and adds none.
  ASSERT_EQ(0, generate({"--samples", "1000", "--srdf", out}).exit_code);
  EXPECT_EQ(once, contentOf(out));
}

TEST_F(GenerateAcm, LosesNothingOfAnExistingFile)
{
  folder.write("out.srdf", "<robot name=\"line--up\"><group name=\"all\"><joint name=\"slide\"/></group></robot>");
  EXPECT_EQ(0, generate({"--samples", "10"}).exit_code);
  EXPECT_NE(std::string::npos, contentOf(out).find("<group name=\"all\">"));

  const std::string of_another = "<robot name=\"another\"/>";
  folder.write("out.srdf", of_another);
  const ProgramOutput output = generate({"--samples", "10"});
  EXPECT_EQ(1, output.exit_code);
  EXPECT_NE(std::string::npos, output.err.find("is not an SRDF of robot 'line--up'; choose another name"))
      << output.err;
  const ProgramOutput given =
      generate({"--samples", "10", "--srdf", folder.write("users.srdf", "<robot name=\"line--up\"/>")});
  EXPECT_EQ(1, given.exit_code);
  EXPECT_EQ(of_another, contentOf(out));
}

TEST_F(GenerateAcm, WritesAGroupForTheChainFromTheRootToEachTip)
{
  // A wrist with two fingers of their own: the arm up to the wrist, and the arm with each finger. The camera moves with
  // the wrist, so it makes no group of its own.
  const std::string turn = "<axis xyz=\"0 0 1\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/>";
  urdf = folder.write("hand.urdf", "<robot name=\"hand\">" + boxLink("foot") + boxLink("wrist") + boxLink("camera") +
                                       boxLink("left") + boxLink("right") + boxLink("sign") +
                                       jointXml("arm", "revolute", "foot", "wrist", turn) +
                                       jointXml("mount", "fixed", "wrist", "camera") +
                                       jointXml("grip_left", "revolute", "wrist", "left", turn) +
                                       jointXml("grip_right", "revolute", "wrist", "right", turn) +
                                       jointXml("nail", "fixed", "foot", "sign") + "</robot>");
  const ProgramOutput output = generate({"--samples", "10"});
  ASSERT_EQ(0, output.exit_code);
  EXPECT_NE(std::string::npos, output.err.find("\nplanning groups: wrist, left, right\n")) << output.err;
  std::map<std::string, std::vector<std::string>> groups;
  const auto robot = RobotModel::fromFiles(urdf, out, {});
  for (const Group& group : robot->groups())
    groups[group.name] = jointNames(*robot, group.joints);
  const std::map<std::string, std::vector<std::string>> expected = {
      {"wrist", {"arm"}}, {"left", {"arm", "grip_left"}}, {"right", {"arm", "grip_right"}}};
  EXPECT_EQ(expected, groups);

  // The groups are the user's from then on.
  const std::string once = contentOf(out);
  ASSERT_EQ(0, generate({"--samples", "10", "--srdf", out}).exit_code);
  EXPECT_EQ(once, contentOf(out));
}

TEST_F(GenerateAcm, ErrorsHaveTheToolsExitCodes)
{
  EXPECT_EQ(2, runProgram(GPS_GENERATE_ACM, {}).exit_code);
  EXPECT_EQ(2, generate({"--samples", "0"}).exit_code);
  EXPECT_EQ(2, generate({"--always-share", "1.5"}).exit_code);
  EXPECT_EQ(1, generate({"--srdf", folder.path("missing.srdf")}).exit_code);
  out = folder.path("no/such/folder.srdf");
  EXPECT_EQ(1, generate({"--samples", "10"}).exit_code);
}

struct RealRobot
{
  const char* name;
  const char* urdf;
  const char* package;  ///< the package in the URDF's folder; empty if the URDF has relative paths
};

class GenerateAcmForRealRobots : public testing::TestWithParam<RealRobot>
{
};

/// Checks 20,000 states that the generator has not used.
BatchResult checkFresh(const PlanningScene& scene)
{
  const std::size_t count = 20000;
  const std::size_t width = scene.robot->variables().size();
  std::mt19937_64 generator(20261121);
  std::vector<double> states(count * width);
  for (std::size_t i = 0; i < count; ++i)
    scene.robot->randomState(generator, states.data() + i * width);
  return CpuChecker(std::make_shared<const PlanningScene>(scene)).check(states.data(), count);
}

double shareValid(const BatchResult& result)
{
  return static_cast<double>(std::count(result.valid.begin(), result.valid.end(), 1)) /
         static_cast<double>(result.valid.size());
}

TEST_P(GenerateAcmForRealRobots, NeverPairsStayFreeAndTheRobotCanMove)
{
  const std::string data = GPS_DART_DATA_DIR;
  const std::string urdf = data + "/" + GetParam().urdf;
  if (!std::filesystem::exists(urdf))
    GTEST_SKIP() << "needs " << urdf << " of Debian's dart-doc";
  const std::string package_folder = urdf.substr(0, urdf.rfind('/'));
  std::vector<std::string> arguments = {"--urdf", urdf};
  RobotModelOptions options;
  if (*GetParam().package)
  {
    arguments.insert(arguments.end(), {"--package", std::string(GetParam().package) + "=" + package_folder});
    options.packages = packageResolver({{GetParam().package, package_folder}});
  }
  const TemporaryFolder folder;
  const std::string srdf = folder.path("robot.srdf");
  arguments.insert(arguments.end(), {"--out", srdf});
  const ProgramOutput output = runProgram(GPS_GENERATE_ACM, arguments);
  ASSERT_EQ(0, output.exit_code) << output.err;
  const auto robot = RobotModel::fromFiles(urdf, srdf, options);

  const double free_share = shareValid(checkFresh(PlanningScene(robot)));
  EXPECT_GT(free_share, 0.1);
  EXPECT_LT(free_share, 0.9);

  // Only the Never pairs are checked. A pair that collides in a share p of the states is taken for Never with
  // probability (1 - p)^10000.
  PlanningScene never(robot);
  never.allowed_collisions = AllowedCollisionMatrix();
  const auto reasons = reasonsOf(*robot);
  for (const Link& first : robot->links())
    for (const Link& second : robot->links())
    {
      const auto reason = reasons.find(first.name + "-" + second.name);
      if (reason == reasons.end() ? reasons.count(second.name + "-" + first.name) == 0 : reason->second != "Never")
        never.allowed_collisions.setEntry(first.name, second.name, true);
    }
  EXPECT_GT(shareValid(checkFresh(never)), 0.999);
}

INSTANTIATE_TEST_SUITE_P(Debian, GenerateAcmForRealRobots,
                         testing::Values(RealRobot{"Kr5", "urdf/KR5/KR5 sixx R650.urdf", ""},
                                         RealRobot{"Wam", "urdf/wam/wam.urdf", "herb_description"}),
                         [](const auto& parameter) { return parameter.param.name; });
}  // namespace
}  // namespace gpu_planning_scene::core
