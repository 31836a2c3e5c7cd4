// Names in a URDF that urdfdom would pass over in silence, so that the robot would lose a shape or stand elsewhere.

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "model/description/urdf_names.h"
#include "model/model_testing.h"
#include "model/real_robots.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A robot with one name in a line, so that a line is replaced to make a fault.
const std::vector<std::string>& robotLines()
{
  static const std::vector<std::string> lines = {
      "<robot name='test'>",
      "<link name='a'>",
      "<collision>",
      "<origin xyz='0 0 1' rpy='0 0 1'/>",
      "<geometry>",
      "<cylinder radius='1' length='2'/>",
      "</geometry>",
      "</collision>",
      "</link>",
      "<link name='b'><collision><geometry><sphere radius='1'/></geometry></collision></link>",
      "<joint name='j' type='revolute'>",
      "<parent link='a'/>",
      "<child link='b'/>",
      "<origin xyz='0 0 1'/>",
      "<axis xyz='0 0 1'/>",
      "<limit lower='-1' upper='1' effort='1' velocity='1'/>",
      "</joint>",
      "<link name='c'/>",
      "<joint name='k' type='continuous'><parent link='b'/><child link='c'/>",
      "<mimic joint='j' multiplier='2' offset='1'/>",
      "</joint>",
      "</robot>"};
  return lines;
}

/// The robot with `text` in place of a line, or after it.
std::string robotWith(std::size_t line, const std::string& text, bool after = false)
{
  std::string urdf;
  for (std::size_t i = 0; i < robotLines().size(); ++i)
    urdf += (i + 1 != line ? robotLines()[i] : after ? robotLines()[i] + text : text) + "\n";
  return urdf;
}

std::string errorOfUrdf(const std::string& urdf, std::vector<std::string>* warnings = nullptr)
{
  RobotModelOptions options;
  options.urdf_name = "test.urdf";
  return errorOf([&] { RobotModel::fromXml(urdf, "", options, warnings); });
}

struct Fault
{
  const char* name;
  std::size_t line;
  bool after;  ///< the text is added to the line; else it replaces the line
  const char* text;
  const char* message;  ///< how the message begins, after the place
};

std::ostream& operator<<(std::ostream& out, const Fault& fault)
{
  return out << fault.name;
}

const std::vector<Fault>& faults()
{
  static const std::vector<Fault> all = {
      {"SecondShape", 6, true, "<box size='1 1 1'/>", "link 'a': a second shape, <box>, in <geometry>"},
      {"SecondShapeOfAVendor", 6, true, "<tetrahedron/>", "link 'a': a second shape, <tetrahedron>, in <geometry>"},
      {"SecondGeometry", 7, true, "<geometry><box size='1 1 1'/></geometry>",
       "link 'a': a second <geometry> in <collision> (the first is in line 5)"},
      {"SecondOrigin", 4, true, "<origin xyz='0 0 2'/>", "link 'a': a second <origin> in <collision>"},
      {"SecondOriginOfAJoint", 14, true, "<origin xyz='0 0 2'/>", "joint 'j': a second <origin> in <joint>"},
      {"SecondAxis", 15, true, "<axis xyz='1 0 0'/>", "joint 'j': a second <axis> in <joint>"},
      {"SecondLimit", 16, true, "<limit lower='0' upper='0' effort='1' velocity='1'/>", "joint 'j': a second <limit>"},
      {"SecondParent", 12, true, "<parent link='c'/>", "joint 'j': a second <parent> in <joint>"},
      {"SecondMimic", 20, true, "<mimic joint='j'/>", "joint 'k': a second <mimic> in <joint>"},
      {"Quaternion", 4, false, "<origin xyz='0 0 1' quat_xyzw='0 0 0 1'/>",
       "link 'a': the attribute 'quat_xyzw' of <origin> is not supported"},
      {"QuaternionOfAJoint", 14, false, "<origin quat_xyzw='0 0 0 1'/>", "joint 'j': the attribute 'quat_xyzw'"},
      {"Colision", 2, true, "<colision><geometry><box size='1 1 1'/></geometry></colision>",
       "link 'a': unknown element <colision> in <link>; did you mean <collision>?"},
      {"CollisionsInUpperCase", 2, true, "<Collision/>", "link 'a': unknown element <Collision>"},
      {"Orgin", 4, false, "<orgin xyz='0 0 1'/>",
       "link 'a': unknown element <orgin> in <collision>; did you mean <origin>?"},
      {"OrginOfAJoint", 14, false, "<orgin xyz='0 0 1'/>", "joint 'j': unknown element <orgin> in <joint>"},
      {"Axes", 15, false, "<axes xyz='0 0 1'/>", "joint 'j': unknown element <axes> in <joint>; did you mean <axis>?"},
      {"Limits", 16, true, "<limits/>", "joint 'j': unknown element <limits> in <joint>"},
      {"Mimick", 20, false, "<mimick joint='j'/>", "joint 'k': unknown element <mimick> in <joint>"},
      {"Lnk", 18, true, "<lnk name='d'/>", "unknown element <lnk> in <robot>; did you mean <link>?"},
      {"Jiont", 18, true, "<jiont name='d'/>", "unknown element <jiont> in <robot>; did you mean <joint>?"},
      {"Xzy", 4, false, "<origin xzy='0 0 1'/>", "link 'a': unknown attribute 'xzy' of <origin>; did you mean 'xyz'?"},
      {"UpperCaseXyz", 14, false, "<origin XYZ='0 0 1'/>", "joint 'j': unknown attribute 'XYZ' of <origin>"},
      {"OtherAttributeOfAnOrigin", 4, false, "<origin position='0 0 1'/>",
       "link 'a': unknown attribute 'position' of <origin>; it has xyz, rpy"},
      {"Radious", 6, false, "<cylinder radious='1' length='2'/>",
       "link 'a': unknown attribute 'radious' of <cylinder>; did you mean 'radius'?"},
      {"Scal", 6, false, "<mesh filename='x.stl' scal='0.001 0.001 0.001'/>",
       "link 'a': unknown attribute 'scal' of <mesh>; did you mean 'scale'?"},
      {"AxisXzy", 15, false, "<axis xzy='0 0 1'/>", "joint 'j': unknown attribute 'xzy' of <axis>"},
      {"LimitLowr", 16, false, "<limit lowr='-1' upper='1' effort='1' velocity='1'/>",
       "joint 'j': unknown attribute 'lowr' of <limit>; did you mean 'lower'?"},
      {"MimicMultiplyer", 20, false, "<mimic joint='j' multiplyer='2'/>",
       "joint 'k': unknown attribute 'multiplyer' of <mimic>; did you mean 'multiplier'?"},
      {"TextOfAnOrigin", 4, false, "<origin>0 0 1</origin>",
       "link 'a': the content of <origin> would not be read; write it as attributes: xyz, rpy"},
      {"ElementOfAnOrigin", 14, false, "<origin><xyz>0 0 1</xyz></origin>", "joint 'j': the content of <origin>"},
      {"PoseOfSdf", 4, false, "<pose>0 0 1 0 0 0</pose>", "link 'a': <pose> does not belong in <collision>"},
      {"ShapeWithoutGeometry", 7, true, "<box size='1 1 1'/>", "link 'a': <box> does not belong in <collision>"},
      {"GeometryInALink", 8, true, "<geometry><box size='1 1 1'/></geometry>",
       "link 'a': <geometry> does not belong in <link>"},
      {"OriginOfALink", 8, true, "<origin xyz='0 0 1'/>", "link 'a': <origin> does not belong in <link>"},
      {"CollisionInTheRobot", 17, true, "<collision><geometry><box size='1 1 1'/></geometry></collision>",
       "<collision> does not belong in <robot>"},
      {"CollisionInAJoint", 16, true, "<collision/>", "joint 'j': <collision> does not belong in <joint>"},
      {"CollisionInAVisual", 8, true, "<visual><collision/></visual>",
       "link 'a': <collision> does not belong in <visual>"},
      {"LinkInAnUnknownElement", 18, true,
       "<model><link name='d'><collision><geometry><box size='1 1 1'/></geometry></collision></link></model>",
       "<collision> in the unknown element <model> would not be read; remove <model>, or move its content out of it"},
      {"JointInAnUnknownElement", 18, true,
       "<part><joint name='d' type='fixed'><parent link='a'/><child link='d'/></joint></part>",
       "<joint> in the unknown element <part> would not be read"},
      {"CollisionInAnUnknownElement", 8, true,
       "<physics><collision><geometry><box size='1 1 1'/></geometry></collision></physics>",
       "link 'a': <collision> in the unknown element <physics> would not be read"},
      {"JointInALink", 8, true, "<joint name='d' type='fixed'/>", "link 'a': <joint> does not belong in <link>"},
  };
  return all;
}

class UrdfNameErrors : public testing::TestWithParam<Fault>
{
};

TEST_P(UrdfNameErrors, NameLinkAndLine)
{
  const Fault& fault = GetParam();
  const std::string message = errorOfUrdf(robotWith(fault.line, fault.text, fault.after));
  EXPECT_EQ(0u, message.find("test.urdf:" + std::to_string(fault.line) + ": " + fault.message)) << message;
  EXPECT_EQ(std::string::npos, message.find('\n')) << message;
}

INSTANTIATE_TEST_SUITE_P(All, UrdfNameErrors, testing::ValuesIn(faults()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(UrdfNames, OfExtensionsAndNewerVersionsPassInSilence)
{
  for (const auto& [line, text] : std::vector<std::pair<std::size_t, std::string>>{
           {1, "<!-- a robot -->"},
           {2, "<sensor/><self_collision_checking><origin/></self_collision_checking><contact/>"},
           {3, "<verbose value='1'/><contact_coefficients mu='1'/><drake:proximity_properties/>"},
           {4, "<!-- <origin/> -->"},
           {6, "<drake:ellipsoid a='1' b='1' c='1'/>"},
           {14, "<dynamics damping='1'/><calibration rising='0'/><hardwareInterface/>"},
           {18, "<gazebo><link/><collision/><joint/><origin/><pose/></gazebo>"},
           {18, "<ros2_control><joint name='j'><command_interface name='position'/></joint></ros2_control>"},
           {18, "<transmission><joint name='j'/><actuator/></transmission>"},
           {18, "<loop_joint name='l'><link1 link='a' xyz='0 0 0'/></loop_joint>"}})
  {
    std::vector<std::string> warnings;
    EXPECT_EQ("", errorOfUrdf(robotWith(line, text, true), &warnings)) << text;
    EXPECT_TRUE(warnings.empty()) << text << ": " << warnings[0];
  }
  std::vector<std::string> warnings;
  EXPECT_EQ("",
            errorOfUrdf(robotWith(6, "<cylinder radius='1' length='2'><drake:declare_convex/></cylinder>"), &warnings));
  EXPECT_EQ("", errorOfUrdf(robotWith(16,
                                      "<limit lower='-1' upper='1' effort='1' velocity='1' acceleration='1' "
                                      "jerk='1'/>"),
                            &warnings));
  EXPECT_TRUE(warnings.empty()) << warnings[0];
}

TEST(UrdfNames, ThatChangeNoGeometryAreWarnings)
{
  std::vector<std::string> warnings;
  EXPECT_EQ("",
            errorOfUrdf(robotWith(16, "<limit min='-1' lower='-1' upper='1' effort='1' velocity='1'/>"), &warnings));
  EXPECT_EQ((std::vector<std::string>{
                "test.urdf:16: joint 'j': unknown attribute 'min' of <limit> is not used; it has lower, upper, effort, "
                "velocity, acceleration, deceleration, jerk"}),
            warnings);
}

TEST(UrdfNames, OfRealRobotsAreKnown)
{
  const std::string shared = GPS_SHARED_DIR;
  std::vector<std::string> files = {
      panda().urdf,
      kr5().urdf,
      wam().urdf,
      drchubo().urdf,
      ur5Robotiq().urdf,
      std::string(GPS_DART_DATA_DIR) + "/sdf/atlas/atlas_v3.urdf",
      shared + "/moveit/resources/pr2_description/urdf/robot.xml",
      shared + "/cases/g1/g1_29dof.urdf",
      shared + "/cases/shoulder.urdf",
      shared + "/cases/limits.urdf",
  };
  std::size_t read = 0;
  for (const std::string& path : files)
  {
    std::ifstream file(path);
    if (!file)
      continue;
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    std::vector<std::string> warnings;
    EXPECT_EQ("", errorOf([&] { checkUrdfNames(XmlText(text, path, "robot"), warnings); }));
    EXPECT_TRUE(warnings.empty()) << warnings[0];
    ++read;
  }
  if (read == 0)
    GTEST_SKIP() << "there are neither robots in " << shared << " nor in " << GPS_DART_DATA_DIR;
}
}  // namespace
}  // namespace gpu_planning_scene::core
