// Runs the tool generate_acm and tests its decisions on pairs of links and the SRDF that it writes.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>

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
  EXPECT_NE(
      std::string::npos,
      output.err.find("collide in the default state, and in a part of the random states, so they stay checked. For "
                      "pairs that may collide, add their lines to the SRDF:\n"
                      "  <disable_collisions link1=\"block\" link2=\"core\" reason=\"User\"/>  "))
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

TEST_F(GenerateAcm, TheCommentsSayWhatProvesThatAPairNeverCollides)
{
  ASSERT_EQ(0, generate({"--samples", "3000", "--seed", "42"}).exit_code);
  const std::string srdf = contentOf(out);
  EXPECT_NE(std::string::npos, srdf.find("3000 random states, seed 42")) << srdf;
  const std::size_t by_reach = srdf.find("Never, because the regions that the two links can reach are apart");
  ASSERT_NE(std::string::npos, by_reach) << srdf;
  EXPECT_LT(by_reach, srdf.find("link1=\"block\" link2=\"spare\"")) << srdf;
  // XML allows no two hyphens in a comment, but the robot's name contains them.
  const std::size_t comment = srdf.find("<!--") + 4;
  EXPECT_EQ(srdf.find("-->"), srdf.find("--", comment)) << srdf;
}

TEST_F(GenerateAcm, TheCommentsNameTheLimitsForWhichTheProofsHold)
{
  ASSERT_EQ(0, generate({"--samples", "100"}).exit_code);
  EXPECT_NE(std::string::npos, contentOf(out).find("The limits are: slide (-5 to 5). -->")) << contentOf(out);
  const std::string planning =
      folder.write("limits.yaml", "joint_limits: {slide: {min_position: -1, max_position: 9}}");
  ASSERT_EQ(0, generate({"--samples", "100", "--planning", planning}).exit_code);
  EXPECT_NE(std::string::npos, contentOf(out).find("The limits are: slide (-1 to 9). -->")) << contentOf(out);
}

TEST_F(GenerateAcm, APairThatCollidesInNoRandomStateStaysCheckedWithoutAProof)
{
  // The corners of the bar, 0.5025 m from the hinge, turn past the post at a distance of 1.5 mm. The balls of Reach are
  // too coarse to prove that.
  const std::string turn = "<axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/>";
  urdf =
      folder.write("gate.urdf", "<robot name='gate'>" + boxes("post", {{-0.604, -0.504}}) + "<link name='hinge'/>" +
                                    boxes("bar", {{-0.5, 0.0}}) + jointXml("turn", "revolute", "post", "hinge", turn) +
                                    jointXml("tilt", "revolute", "hinge", "bar",
                                             "<axis xyz='0 1 0'/><limit lower='-0.001' upper='0.001' effort='1' "
                                             "velocity='1'/>") +
                                    "</robot>");
  const ProgramOutput unproven = generate({"--samples", "1000", "--proof-tests", "0"});
  ASSERT_EQ(0, unproven.exit_code) << unproven.err;
  EXPECT_NE(std::string::npos, unproven.err.find("pairs that remain to be checked: 1; 1 of them collide in no random "
                                                 "state, which proves nothing"))
      << unproven.err;
  EXPECT_EQ(0u, reasonsOf(*RobotModel::fromFiles(urdf, out, {})).count("post-bar"));
  std::filesystem::remove(out);
  const ProgramOutput proven = generate({"--samples", "1000"});
  ASSERT_EQ(0, proven.exit_code) << proven.err;
  EXPECT_EQ("Never", reasonsOf(*RobotModel::fromFiles(urdf, out, {})).at("post-bar")) << proven.err;
  EXPECT_NE(std::string::npos, contentOf(out).find("Never, because all joint values between the two links"));
}

/// Two arms beside each other, with fingers that are a tenth of a millimetre thick. The right arm is the mirror image
/// of the left one.
std::string thinFingersUrdf()
{
  const auto link = [](const std::string& name, double length, double width)
  {
    const std::string size = std::to_string(length) + " " + std::to_string(width) + " " + std::to_string(width);
    return "<link name='" + name + "'><collision><origin xyz='" + std::to_string(0.5 * length) +
           " 0 0'/><geometry><box size='" + size + "'/></geometry></collision></link>";
  };
  const auto joint = [](const std::string& name, const std::string& parent, const std::string& child,
                        const std::string& at, const std::string& axis, double range)
  {
    const std::string bound = std::to_string(range);
    return jointXml(name, "revolute", parent, child,
                    "<origin xyz='" + at + "'/><axis xyz='" + axis + "'/><limit lower='-" + bound + "' upper='" +
                        bound + "' effort='1' velocity='1'/>");
  };
  std::string urdf = "<robot name='two_arms'>" + link("body", 0.02, 0.02);
  for (const std::string side : {"left", "right"})
    urdf += link(side + "_upper", 0.3, 0.02) + link(side + "_fore", 0.25, 0.004) + link(side + "_finger", 0.03, 1e-4) +
            joint(side + "_shoulder", "body", side + "_upper", side == "left" ? "0 0.3 0" : "0 -0.3 0", "0 0 1", 3.0) +
            joint(side + "_elbow", side + "_upper", side + "_fore", "0.3 0 0", "0 0 1", 2.8) +
            joint(side + "_wrist", side + "_fore", side + "_finger", "0.25 0 0", "0 1 0", 1.5);
  return urdf + "</robot>";
}

class ThinFingers : public GenerateAcm
{
 public:
  ThinFingers()
  {
    urdf = folder.write("two_arms.urdf", thinFingersUrdf());
    old = folder.write("old.srdf", R"(<robot name="two_arms">
  <disable_collisions link1="body" link2="left_upper" reason="Adjacent"/>
  <disable_collisions link1="body" link2="right_upper" reason="Adjacent"/></robot>)");
  }

  /// Whether the SRDF that was written leaves the pair of fingers checked.
  bool fingersAreChecked() const
  {
    const auto robot = RobotModel::fromFiles(urdf, out, {});
    return !AllowedCollisionMatrix::fromRobot(*robot).allowed("left_finger", "right_finger");
  }

  std::string old;
};

TEST_F(ThinFingers, CollideInAMirroredStateAndInVeryFewRandomStates)
{
  const auto robot = RobotModel::fromFiles(urdf, "", {});
  PlanningScene scene(robot);
  for (const Link& first : robot->links())
    for (const Link& second : robot->links())
      scene.allowed_collisions.setEntry(first.name, second.name, true);
  scene.allowed_collisions.setEntry("left_finger", "right_finger", false);
  CpuChecker checker(std::make_shared<const PlanningScene>(scene));
  // Both fingers cross the plane between the arms at the same point.
  const double mirrored[] = {-1.0, 0.8194, 0.0, 1.0, -0.8194, 0.0};
  EXPECT_EQ(0, checker.check(mirrored, 1).valid[0]);
  std::mt19937_64 generator(20261127);
  std::vector<double> states(std::size_t{100000} * 6);
  for (std::size_t i = 0; i < 100000; ++i)
    robot->randomState(generator, states.data() + i * 6);
  const BatchResult random = checker.check(states.data(), 100000);
  EXPECT_LE(std::count(random.valid.begin(), random.valid.end(), 0), 10);
}

TEST_F(ThinFingers, StayCheckedForEachSeedAndForAnOldSrdf)
{
  for (const char* seed : {"0", "1", "2", "3"})
  {
    std::filesystem::remove(out);
    ASSERT_EQ(0, generate({"--samples", "2000", "--proof-tests", "2000", "--seed", seed}).exit_code);
    EXPECT_TRUE(fingersAreChecked()) << "seed " << seed;
    for (const bool drop : {false, true})
    {
      std::filesystem::remove(out);
      std::vector<std::string> arguments = {"--samples", "2000", "--proof-tests", "2000",
                                            "--seed",    seed,   "--srdf",        old};
      if (drop)
        arguments.push_back("--drop-checked");
      ASSERT_EQ(0, generate(arguments).exit_code);
      EXPECT_TRUE(fingersAreChecked()) << "seed " << seed;
    }
  }
}

TEST_F(GenerateAcm, APairThatTheSrdfChecksStaysCheckedAndIsListed)
{
  const std::string old = folder.write("old.srdf", R"(<robot name="line--up">
  <disable_collisions link1="block" link2="mount" reason="Adjacent"/>
  <disable_collisions link1="block" link2="half" reason="Never"/>
  <disable_collisions link1="mount" link2="cover" reason="Never"/></robot>)");
  const ProgramOutput kept = generate({"--samples", "1000", "--srdf", old});
  ASSERT_EQ(0, kept.exit_code) << kept.err;
  const auto reasons = reasonsOf(*RobotModel::fromFiles(urdf, out, {}));
  EXPECT_EQ("Adjacent", reasons.at("block-mount"));
  EXPECT_EQ("Never", reasons.at("mount-cover"));
  EXPECT_EQ(2u, reasons.size()) << "all other pairs stay checked";
  const auto printed = [](const ProgramOutput& output, const std::string& text)
  { return output.err.find(text) != std::string::npos; };
  EXPECT_TRUE(printed(kept, "the SRDF checks these pairs, so they stay checked; --drop-checked disables them:\n"))
      << kept.err;
  EXPECT_TRUE(printed(kept, "  block - spare: Never, proven by their reach\n")) << kept.err;
  EXPECT_TRUE(printed(kept, "  block - sleeve: Default\n")) << kept.err;
  EXPECT_TRUE(printed(kept, "  half - cover: Adjacent\n")) << kept.err;
  // The other direction: a wrong entry of the SRDF.
  EXPECT_TRUE(printed(kept,
                      "the SRDF disables these pairs, but they can collide, so they are checked now:\n"
                      "  block - half: "))
      << kept.err;

  std::filesystem::remove(out);
  const ProgramOutput dropped = generate({"--samples", "1000", "--srdf", old, "--drop-checked"});
  ASSERT_EQ(0, dropped.exit_code) << dropped.err;
  const auto all = reasonsOf(*RobotModel::fromFiles(urdf, out, {}));
  EXPECT_EQ("Never", all.at("block-spare"));
  EXPECT_EQ("Adjacent", all.at("half-cover"));
  EXPECT_EQ(0u, all.count("block-half"));
  EXPECT_TRUE(printed(dropped, "disabled, although the SRDF checks them:\n")) << dropped.err;
  EXPECT_TRUE(printed(dropped, "  block - spare: Never, proven by their reach\n")) << dropped.err;
}

TEST_F(GenerateAcm, PairsThatAreOnlyUnprovenForWiderLimitsAreProvenAnew)
{
  const std::string old = folder.write("old.srdf", R"(<robot name="line--up">
  <disable_collisions link1="block" link2="mount" reason="Adjacent"/>
  <disable_collisions link1="mount" link2="cover" reason="Never"/></robot>)");
  const std::string planning =
      folder.write("limits.yaml", "joint_limits: {slide: {min_position: -1, max_position: 9}}");
  const ProgramOutput output = generate({"--samples", "1000", "--srdf", old, "--planning", planning});
  ASSERT_EQ(0, output.exit_code) << output.err;
  EXPECT_NE(std::string::npos, output.err.find("1 pairs of links that are disabled with the reason Never are checked"))
      << output.err;
  RobotModelOptions limits;
  limits.joint_limits = {{"slide", -1.0, 9.0}};
  const auto reasons = reasonsOf(*RobotModel::fromFiles(urdf, out, limits));
  EXPECT_EQ("Never", reasons.at("mount-cover"));
  EXPECT_EQ(std::string::npos, output.err.find("  mount - cover")) << output.err;
}

TEST_F(GenerateAcm, AnExistingOutputIsAnOldSrdfToo)
{
  const std::string old = R"(<robot name="line--up">
  <disable_collisions link1="block" link2="mount" reason="Adjacent"/>
  <disable_collisions link1="block" link2="half" reason="User"/></robot>)";
  folder.write("out.srdf", old);
  const ProgramOutput output = generate({"--samples", "1000"});
  ASSERT_EQ(0, output.exit_code) << output.err;
  const auto reasons = reasonsOf(*RobotModel::fromFiles(urdf, out, {}));
  EXPECT_EQ("User", reasons.at("block-half"));
  EXPECT_EQ(0u, reasons.count("block-spare"));
  EXPECT_NE(std::string::npos, output.err.find("  block - spare: Never, proven by their reach\n")) << output.err;
}

TEST_F(GenerateAcm, AnSrdfWithoutDisabledPairsGetsAWholeMatrix)
{
  const std::string groups = folder.write(
      "groups.srdf", "<robot name=\"line--up\"><group name=\"all\"><joint name=\"slide\"/></group></robot>");
  ASSERT_EQ(0, generate({"--samples", "1000", "--srdf", groups}).exit_code);
  EXPECT_EQ("Never", reasonsOf(*RobotModel::fromFiles(urdf, out, {})).at("block-spare"));
}

TEST_F(GenerateAcm, PairsThatAreDisabledAlthoughTheyCanBeFreeAreNamed)
{
  const ProgramOutput output = generate({"--samples", "2000"});
  ASSERT_EQ(0, output.exit_code);
  EXPECT_NE(std::string::npos,
            output.err.find("warning: 'block' and 'cover' are disabled as Always, but they are free in "))
      << output.err;
  EXPECT_EQ(std::string::npos, output.err.find("'block' and 'sleeve' are disabled")) << output.err;
}

TEST_F(GenerateAcm, LinksWithThreeJointsBetweenThemAreNotAdjacent)
{
  const auto turn = [](const std::string& axis)
  { return "<axis xyz='" + axis + "'/><limit lower='-1.5' upper='1.5' effort='1' velocity='1'/>"; };
  urdf = folder.write(
      "shoulder.urdf",
      "<robot name='shoulder'><link name='torso'><collision><geometry><box size='0.3 0.3 0.6'/></geometry></collision>"
      "</link><link name='pan'/><link name='lift'/><link name='arm'><collision><origin xyz='0 0 -0.2'/><geometry>"
      "<box size='0.1 0.1 0.4'/></geometry></collision></link>" +
          jointXml("1", "revolute", "torso", "pan", "<origin xyz='0 0.25 0.2'/>" + turn("0 1 0")) +
          jointXml("2", "revolute", "pan", "lift", turn("1 0 0")) +
          jointXml("3", "revolute", "lift", "arm", turn("0 0 1")) + "</robot>");
  ASSERT_EQ(0, generate({"--samples", "1000"}).exit_code);
  // Without an SRDF and with the generated one: the arm swings into the torso.
  const double in_torso[] = {0.0, -1.2, 0.0};
  for (const std::string& srdf : {std::string(), out})
  {
    const auto robot = RobotModel::fromFiles(urdf, srdf, {});
    EXPECT_EQ(0, CpuChecker(std::make_shared<const PlanningScene>(robot)).check(in_torso, 1).valid[0]) << srdf;
  }
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
  EXPECT_EQ(0, generate({"--samples", "100"}).exit_code);
  EXPECT_NE(std::string::npos, contentOf(out).find("<group name=\"all\">"));

  const std::string of_another = "<robot name=\"another\"/>";
  folder.write("out.srdf", of_another);
  const ProgramOutput output = generate({"--samples", "100"});
  EXPECT_EQ(1, output.exit_code);
  EXPECT_NE(std::string::npos, output.err.find("is not an SRDF of robot 'line--up'; choose another name"))
      << output.err;
  const ProgramOutput given =
      generate({"--samples", "100", "--srdf", folder.write("users.srdf", "<robot name=\"line--up\"/>")});
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
  const ProgramOutput output = generate({"--samples", "100"});
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
  ASSERT_EQ(0, generate({"--samples", "100", "--srdf", out}).exit_code);
  EXPECT_EQ(once, contentOf(out));
}

TEST_F(GenerateAcm, ErrorsHaveTheToolsExitCodes)
{
  EXPECT_EQ(2, runProgram(GPS_GENERATE_ACM, {}).exit_code);
  EXPECT_EQ(2, generate({"--samples", "0"}).exit_code);
  EXPECT_EQ(2, generate({"--always-share", "1.5"}).exit_code);
  EXPECT_EQ(2, generate({"--proof-tests", "many"}).exit_code);
  EXPECT_EQ(1, generate({"--srdf", folder.path("missing.srdf")}).exit_code);
  out = folder.path("no/such/folder.srdf");
  EXPECT_EQ(1, generate({"--samples", "100"}).exit_code);
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
  CheckerOptions options;
  options.reductions = Reductions::none();  // the generator's proofs use the bounds of the reductions
  return CpuChecker(std::make_shared<const PlanningScene>(scene), options).check(states.data(), count);
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
  arguments.insert(arguments.end(), {"--proof-tests", "2000", "--out", srdf});
  const ProgramOutput output = runProgram(GPS_GENERATE_ACM, arguments);
  ASSERT_EQ(0, output.exit_code) << output.err;
  const auto robot = RobotModel::fromFiles(urdf, srdf, options);

  const double free_share = shareValid(checkFresh(PlanningScene(robot)));
  EXPECT_GT(free_share, 0.1);
  EXPECT_LT(free_share, 0.9);

  // Only the Never pairs are checked. They are proven, so no state collides.
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
  EXPECT_EQ(1.0, shareValid(checkFresh(never)));
}

INSTANTIATE_TEST_SUITE_P(Debian, GenerateAcmForRealRobots,
                         testing::Values(RealRobot{"Kr5", "urdf/KR5/KR5 sixx R650.urdf", ""},
                                         RealRobot{"Wam", "urdf/wam/wam.urdf", "herb_description"}),
                         [](const auto& parameter) { return parameter.param.name; });
}  // namespace
}  // namespace gpu_planning_scene::core
