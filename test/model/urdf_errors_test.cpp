#include <gtest/gtest.h>

#include "model/mesh_files.h"
#include "model/model_testing.h"
#include "support/xacro_stand_in.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string urdfError(const std::string& urdf)
{
  return errorOf([&] { robotOf(urdf); });
}

// Every message is one line that begins with the file and line number and names the cause.
void expectUrdfError(const std::string& urdf, const std::string& where, const std::string& text)
{
  const std::string message = urdfError(urdf);
  EXPECT_EQ(message.find(where), 0u) << message;
  EXPECT_NE(message.find(text), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

const std::string kTwoLinks = "<link name=\"a\"/><link name=\"b\"/>\n";

TEST(UrdfErrors, MalformedXmlIsNamedWithItsLine)
{
  expectUrdfError("\n<link name=\"a\">\n</lnk>", "test.urdf:2: malformed XML", "mismatched");
  expectUrdfError("\n\n<link name=a/>", "test.urdf:3: malformed XML", "attribute");
  const auto whole = [](const std::string& text)
  { return errorOf([&] { RobotModel::fromXml(text, "", RobotModelOptions()); }); };
  EXPECT_NE(whole("This is not a valid URDF file.").find("robot_description:1: malformed XML"), std::string::npos);
  EXPECT_NE(whole("").find("robot_description:1: malformed XML"), std::string::npos);
  EXPECT_NE(whole("<!-- nothing -->").find("robot_description"), std::string::npos);
  EXPECT_NE(whole("\n<sdf/>").find("robot_description:2: the root element is <sdf>"), std::string::npos);
  EXPECT_NE(whole("<robot name=\"r\"/>"), "");
  EXPECT_NE(whole("<robot><link name=\"a\"/></robot>"), "");
}

TEST(UrdfErrors, XacroIsRefusedWithTheCommandToRun)
{
  expectUrdfError("<link name='a'/>\n<xacro:macro name='arm'/>", "test.urdf:2: <xacro:macro> is xacro",
                  "xacro FILE > expanded.urdf, or for the launch file urdf_command:=\"xacro FILE\"");
  expectUrdfError("<link name='a'><collision><geometry>\n<box size='1 1 ${height}'/></geometry></collision></link>",
                  "test.urdf:2: size=\"1 1 ${height}\" is xacro", "urdf_command");
}

TEST(UrdfErrors, TheCommandForXacroNamesTheGivenFile)
{
  const TemporaryFolder folder;
  const PathVariable without_xacro(folder.path(""));
  const std::string robot = "<robot name='r'><link name='a'/><xacro:macro name='arm'/></robot>";
  const auto message_for = [&](const std::string& name)
  { return errorOf([&] { RobotModel::fromFiles(folder.write(name, robot), "", {}); }); };
  const std::string command = "xacro '" + folder.path("my arm.xacro") + "'";
  const std::string message = message_for("my arm.xacro");
  EXPECT_NE(message.find(command + " > expanded.urdf"), std::string::npos) << message;
  EXPECT_NE(message.find("urdf_command:=\"" + command + "\" instead of urdf:=FILE"), std::string::npos) << message;
  EXPECT_NE(message_for("Sam's arm.xacro").find("urdf_command:=\"xacro FILE\""), std::string::npos);
}

TEST(UrdfErrors, AMacroCallThatXacroLeftIsAWarning)
{
  std::vector<std::string> warnings;
  robotOf("<link name='a'/>\n<xacro:gazebo_head name='head'/>", "", &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("test.urdf:2: <xacro:gazebo_head> was not expanded by xacro: what the macro makes, for "
                             "example links, is missing"),
            0u)
      << warnings[0];
}

TEST(UrdfErrors, AnSrdfInItsPlaceIsRefused)
{
  expectUrdfError("\n<group name='arm'/>", "test.urdf:2: <group> without any <link>: this is an SRDF", "srdf:=FILE");
}

TEST(UrdfErrors, LimitsMustBeThereAndInOrder)
{
  expectUrdfError(kTwoLinks + jointXml("j", "revolute", "a", "b"), "test.urdf:2:", "[j]");
  expectUrdfError(kTwoLinks + jointXml("j", "prismatic", "a", "b"), "test.urdf:2:", "[j]");
  expectUrdfError(
      kTwoLinks + jointXml("j", "revolute", "a", "b", R"(<limit lower="2" upper="-1" effort="1" velocity="1"/>)"),
      "test.urdf:2: joint 'j'", "lower limit above its upper limit");
}

TEST(UrdfErrors, NumbersMustBeFinite)
{
  expectUrdfError(
      kTwoLinks + jointXml("j", "revolute", "a", "b", R"(<limit lower="nan" upper="1" effort="1" velocity="1"/>)"),
      "test.urdf", "j");
  expectUrdfError(
      kTwoLinks + jointXml("j", "revolute", "a", "b", R"(<limit lower="-inf" upper="inf" effort="1" velocity="1"/>)"),
      "test.urdf", "j");
  expectUrdfError(R"(<link name="a"><collision><geometry><box size="1 nan 1"/></geometry></collision></link>)",
                  "test.urdf:1: link 'a'", "nan");
  expectUrdfError(
      "<link name=\"a\"><collision><origin xyz=\"0 inf 0\"/><geometry><sphere radius=\"1\"/></geometry>"
      "</collision></link>",
      "test.urdf:1: link 'a'", "inf");
}

TEST(UrdfErrors, NothingIsPlacedFurtherThanAThousandKilometres)
{
  expectUrdfError(kTwoLinks + jointXml("j", "fixed", "a", "b", "<origin xyz='0 -1.1e6 0'/>"), "test.urdf:2: joint 'j'",
                  "more than 1000 km");
  expectUrdfError(
      "<link name=\"a\"><collision><origin xyz=\"1e39 0 0\"/><geometry><sphere radius=\"1\"/></geometry>"
      "</collision></link>",
      "test.urdf:1: link 'a'", "more than 1000 km");
}

TEST(UrdfErrors, TheAxisMustHaveALength)
{
  expectUrdfError(kTwoLinks + jointXml("j", "continuous", "a", "b", "<axis xyz=\"0 0 0\"/>"), "test.urdf:2: joint 'j'",
                  "axis");
}

TEST(UrdfErrors, TypesAndParentsMustBeKnown)
{
  expectUrdfError(kTwoLinks + jointXml("j", "screw", "a", "b"), "test.urdf:2:", "screw");
  expectUrdfError(kTwoLinks + jointXml("j", "fixed", "a", "c"), "test.urdf:2:", "[c]");
  expectUrdfError(kTwoLinks + jointXml("j", "fix\ned", "a", "b"), "test.urdf:2:", "fix ed");
}

TEST(UrdfErrors, LinksMustFormATree)
{
  EXPECT_NE(urdfError(kTwoLinks).find("wo root links"), std::string::npos) << urdfError(kTwoLinks);
  expectUrdfError(kTwoLinks + jointXml("j", "fixed", "a", "b") + jointXml("k", "fixed", "b", "a"),
                  "test.urdf:", "loop");
  const std::string four_links = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/><link name=\"d\"/>\n";
  expectUrdfError(four_links + jointXml("1", "fixed", "a", "b") + jointXml("2", "fixed", "a", "c") +
                      jointXml("3", "fixed", "b", "d") + jointXml("4", "fixed", "c", "d"),
                  "test.urdf:5: link 'd'", "child of several joints");
  expectUrdfError(four_links + jointXml("1", "fixed", "a", "b") + jointXml("2", "fixed", "c", "d") +
                      jointXml("3", "fixed", "d", "c"),
                  "test.urdf:", "loop");
  expectUrdfError(kTwoLinks + "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/></joint>", "test.urdf:2: joint 'j'",
                  "lacks a parent or a child");
}

TEST(UrdfErrors, MimicsMustLeadToAJointWithOneVariable)
{
  const std::string links = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/><link name=\"d\"/>\n";
  const auto mimic = [](const std::string& leader) { return kLimits + ("<mimic joint=\"" + leader + "\"/>"); };
  expectUrdfError(links + jointXml("1", "revolute", "a", "b", mimic("9")) + jointXml("2", "fixed", "a", "c") +
                      jointXml("3", "fixed", "a", "d"),
                  "test.urdf:2: joint '1'", "mimics joint '9'");
  const std::string loop = jointXml("1", "revolute", "a", "b", mimic("2")) +
                           jointXml("2", "revolute", "a", "c", mimic("1")) + jointXml("3", "fixed", "a", "d");
  expectUrdfError(links + loop, "test.urdf:2: joint '1'", "mimics itself");
  const std::string into_a_loop = jointXml("1", "revolute", "a", "b", mimic("2")) +
                                  jointXml("2", "revolute", "a", "c", mimic("3")) +
                                  jointXml("3", "revolute", "a", "d", mimic("2"));
  expectUrdfError(links + into_a_loop, "test.urdf:2: joint '1'", "mimics itself");
  for (const char* type : {"fixed", "floating", "planar"})
  {
    expectUrdfError(links + jointXml("1", "revolute", "a", "b", mimic("2")) + jointXml("2", type, "a", "c") +
                        jointXml("3", "fixed", "a", "d"),
                    "test.urdf:2: joint '1'", "joint '2' is not revolute");
  }
  expectUrdfError(links + jointXml("1", "continuous", "a", "b") + jointXml("2", "floating", "a", "c", mimic("1")) +
                      jointXml("3", "fixed", "a", "d"),
                  "test.urdf:3: joint '2'", "is not revolute");
}

TEST(UrdfErrors, TheMimicOfAFixedJointIsIgnoredWithAWarning)
{
  std::vector<std::string> warnings;
  const auto robot = robotOf(kTwoLinks + jointXml("j", "fixed", "a", "b", "<mimic joint=\"j\"/>"), "", &warnings);
  EXPECT_FALSE(robot->joints()[0].mimic);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("test.urdf:2: joint 'j'"), std::string::npos) << warnings[0];
}

TEST(UrdfErrors, BadShapesAreNamedWithTheirLink)
{
  const auto link = [](const std::string& geometry)
  { return "\n<link name=\"a\">\n<collision><geometry>" + geometry + "</geometry></collision></link>"; };
  expectUrdfError(link("<sphere radius=\"-1\"/>"), "test.urdf:2: link 'a'", "radius");
  expectUrdfError(link("<box size=\"1 -1 1\"/>"), "test.urdf:2: link 'a'", "size along y");
  expectUrdfError(link("<capsule/>"), "test.urdf:2:", "capsule");
  expectUrdfError(link("<mesh filename=\"/no/such/mesh.stl\"/>"), "test.urdf:2: link 'a'", "/no/such/mesh.stl");
  expectUrdfError(link("<mesh filename=\"mesh.stl\"/>"), "test.urdf:2: link 'a'", "relative");
  expectUrdfError(link("<mesh filename=\"package://p/mesh.stl\"/>"), "test.urdf:2: link 'a'", "package 'p'");
}

TEST(UrdfErrors, PointsAreLeftOutAndFlatShapesKeptWithAWarning)
{
  const auto collision = [](const std::string& shape)
  { return "<collision><geometry>" + shape + "</geometry></collision>"; };
  std::vector<std::string> warnings;
  const auto robot =
      robotOf("<link name='a'>" + collision("<cylinder length='0' radius='0'/>") + collision("<box size='0 0 0'/>") +
                  collision("<sphere radius='0'/>") + collision("<mesh filename='none.stl' scale='0 0 0'/>") +
                  collision("<cylinder length='0' radius='2'/>") + collision("<box size='1 0 3'/>") +
                  collision("<sphere radius='1'/>") + "</link>",
              "", &warnings);
  const auto left_out = [](const std::string& shape)
  { return "test.urdf:1: link 'a': a <" + shape + "> of size 0 is left out, because it is a point"; };
  const auto flat = [](const std::string& shape)
  {
    return "test.urdf:1: link 'a': a <" + shape +
           "> has a size of 0, so it is flat or a line; it is checked with 1e-9 m instead";
  };
  EXPECT_EQ((std::vector<std::string>{left_out("cylinder"), left_out("box"), left_out("sphere"), left_out("mesh"),
                                      flat("cylinder"), flat("box")}),
            warnings);
  const std::vector<PlacedShape>& shapes = robot->links()[0].shapes;
  ASSERT_EQ(3u, shapes.size());
  EXPECT_EQ(1e-9, std::get<Cylinder>(shapes[0].shape).length);
  EXPECT_EQ(Eigen::Vector3d(1, 1e-9, 3), std::get<Box>(shapes[1].shape).size);
}

TEST(UrdfErrors, NoCollisionElementIsLostBehindABadOne)
{
  const std::string good = "<collision><geometry><sphere radius=\"1\"/></geometry></collision>";
  for (const char* bad :
       {"<collision/>", "<collision><geometry/></collision>", "<collision><geometry><mesh/></geometry></collision>",
        "<collision><geometry><sphere radius=\"x\"/></geometry></collision>"})
  {
    expectUrdfError("<link name=\"a\">" + good + bad + good + "</link>", "test.urdf:1: link 'a'",
                    "collision element that cannot be read");
  }
}

TEST(UrdfErrors, BadLooksAndInertiaDoNotMatter)
{
  const auto robot = robotOf(R"(<material name="m"/>
    <link name="a"><inertial><mass/></inertial><visual><geometry><mesh/></geometry></visual>
    <visual><geometry><box size="1 1 1"/></geometry><material/></visual>
    <collision><geometry><sphere radius="1"/></geometry></collision></link>)");
  EXPECT_EQ(robot->links()[0].shapes.size(), 1u);
}

TEST(UrdfErrors, UrdfdomsOwnMessagesGoIntoTheErrorAlone)
{
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const std::string message = urdfError(kTwoLinks + jointXml("j", "revolute", "a", "b"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_NE(message.find("does not specify limits"), std::string::npos) << message;
}

TEST(UrdfErrors, FilesAreNamedWhereTheyCannotBeRead)
{
  const TemporaryFolder folder;
  const std::string urdf = folder.write("my robot.urdf", "<robot name=\"r\"><link name=\"a\"/></robot>");
  EXPECT_EQ(errorOf([&] { RobotModel::fromFiles(urdf, "", {}); }), "");
  EXPECT_NE(errorOf([&] { RobotModel::fromFiles(folder.path("x.urdf"), "", {}); }).find("x.urdf"), std::string::npos);
  EXPECT_NE(errorOf([&] { RobotModel::fromFiles(folder.path(""), "", {}); }).find("URDF"), std::string::npos);
  EXPECT_NE(errorOf([&] { RobotModel::fromFiles(urdf, folder.path("x.srdf"), {}); }).find("x.srdf"), std::string::npos);
  const std::string empty = folder.write("empty.srdf", "");
  EXPECT_NE(errorOf([&] { RobotModel::fromFiles(urdf, empty, {}); }).find("empty.srdf"), std::string::npos);
}

TEST(UrdfErrors, MeshPathsAreRelativeToTheUrdfFile)
{
  const TemporaryFolder folder;
  folder.write("meshes/part 1.stl", binaryStl(*tessellate(Box{{1, 1, 1}}).mesh));
  const std::string urdf = folder.write("my robot.urdf", R"(<robot name="r"><link name="a"><collision><geometry>
      <mesh filename="meshes/part 1.stl" scale="-1 2 1"/></geometry></collision></link></robot>)");
  const auto robot = RobotModel::fromFiles(urdf, "", {});
  EXPECT_EQ(robot->triangleCount(), 12u);
  const auto& mesh = std::get<std::shared_ptr<const Mesh>>(robot->links()[0].shapes[0].shape);
  EXPECT_EQ(mesh->vertices[0].cwiseAbs(), Eigen::Vector3d(0.5, 1.0, 0.5));
}
}  // namespace
}  // namespace gpu_planning_scene::core
