// .scene files, as RViz's MotionPlanning plugin writes them, in the layouts of old and new versions.

#include "scene/change_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
class SceneText : public testing::Test
{
 protected:
  PlanningScene load(const std::string& text)
  {
    return loadSceneFile(folder_.write("a.scene", text), sliderRobot(), {}, nullptr);
  }

  void refused(const std::string& text, int line, const std::string& fragment)
  {
    const std::string message = errorOf([&] { load(text); });
    EXPECT_NE(std::string::npos, message.find("a.scene:" + std::to_string(line) + ": ")) << message;
    EXPECT_NE(std::string::npos, message.find(fragment)) << message;
    EXPECT_EQ(std::string::npos, message.find('\n')) << message;
  }

  TemporaryFolder folder_;
};

const char* const kNew = R"((noname)+
* big table
1 2 3
0 0 0.7071067811865476 0.7071067811865476
2
box
0.1 0.2 0.3
0 0 1
0 0 0 1
0.5 0.25 0 1
mesh
3 1
0 0 0
1 0 0
0 1 0

0 1 2
0 0 2
0 0 0 1
0 0 0 0
1
corner
1 1 0
0 0 0 1
* wall
0 0 0
0 0 0 1
4
sphere
0.5
0 0 0
0 0 0 1
0 0 0 0
cylinder
0.1 0.4
0 0 0
0 0 0 1
0 0 0 0
cone
0.2 0.6
0 0 0
0 0 0 1
0 0 0 0
plane
0 0 2 -1
0 0 0
0 0 0 1
0 0 0 0
0
.
)";

TEST_F(SceneText, ANewFileHasPosesOfObjectsAndSubframes)
{
  const PlanningScene scene = load(kNew);
  EXPECT_EQ("(noname)+", scene.name);
  ASSERT_EQ(2u, scene.objects.size());
  const WorldObject& table = scene.objects[0];
  EXPECT_EQ("big table", table.id);
  EXPECT_TRUE(table.pose.isApprox(poseAt(1, 2, 3, M_PI_2), 1e-15));
  ASSERT_EQ(2u, table.shapes.size());
  EXPECT_EQ(Eigen::Vector3d(0.1, 0.2, 0.3), std::get<Box>(table.shapes[0].shape).size);
  EXPECT_EQ(1.0, table.shapes[0].pose.translation().z());
  EXPECT_EQ(1u, std::get<std::shared_ptr<const Mesh>>(table.shapes[1].shape)->triangles.size());
  EXPECT_EQ(1.0, table.subframes.at("corner").translation().y());
  EXPECT_TRUE(scene.colors.at("big table") == (Color{0.5F, 0.25F, 0.0F, 1.0F}));
  EXPECT_EQ(1u, scene.colors.size()) << "0 0 0 0 is no color";
  const auto& shapes = scene.objects[1].shapes;
  EXPECT_EQ(0.5, std::get<Sphere>(shapes[0].shape).radius);
  EXPECT_EQ(0.1, std::get<Cylinder>(shapes[1].shape).radius);
  EXPECT_EQ(0.4, std::get<Cylinder>(shapes[1].shape).length);
  EXPECT_EQ(0.2, std::get<Cone>(shapes[2].shape).radius);
  EXPECT_EQ(0.6, std::get<Cone>(shapes[2].shape).length);
  EXPECT_EQ(0.5, std::get<HalfSpace>(shapes[3].shape).offset);
}

TEST_F(SceneText, ShapesLieInTheOrderOfMessages)
{
  const PlanningScene scene = load(
      "mixed\n* a\n0 0 0\n0 0 0 1\n2\nmesh\n3 1\n0 0 0\n1 0 0\n0 1 0\n0 1 2\n5 0 0\n0 0 0 1\n0 0 0 0\n"
      "box\n1 1 1\n1 2 3\n0 0 0 1\n0 0 0 0\n0\n.\n");
  const auto& shapes = scene.objects.at(0).shapes;
  ASSERT_EQ(2u, shapes.size());
  EXPECT_TRUE(std::holds_alternative<Box>(shapes[0].shape)) << "a move names the poses of primitives first";
  EXPECT_EQ(2.0, shapes[0].pose.translation().y());
  EXPECT_EQ(5.0, shapes[1].pose.translation().x());
}

TEST_F(SceneText, AnOldFileHasPosesOfShapesAlone)
{
  const PlanningScene scene =
      load("hall\n* a\n1\nbox\n1 1 1\n1 2 3\n0 0 0 1\n0 0 0 0\n* b\n1\nsphere\n2\n0 0 0\n0 0 0 1\n1 0 0 1\n.\n");
  ASSERT_EQ(2u, scene.objects.size());
  EXPECT_TRUE(scene.objects[0].pose.isApprox(poseAt(0, 0, 0)));
  EXPECT_TRUE(scene.objects[0].shapes[0].pose.isApprox(poseAt(1, 2, 3)));
  EXPECT_EQ(1u, scene.colors.count("b"));
}

TEST_F(SceneText, PosesOfObjectsMayBeThereWithoutSubframes)
{
  const PlanningScene scene = load("\n* a\n1 2 3\n0 0 0 1\n1\nbox\n1 1 1\n0 0 0\n0 0 0 1\n0 0 0 0\n.\n");
  EXPECT_TRUE(scene.objects.at(0).pose.isApprox(poseAt(1, 2, 3)));
  EXPECT_EQ("", scene.name);
}

TEST_F(SceneText, ASceneMayBeEmpty)
{
  EXPECT_TRUE(load("nothing\n.\n").objects.empty());
}

TEST_F(SceneText, FaultsAreSaidWithTheirLine)
{
  const std::string sphere = "sphere\n1\n0 0 0\n0 0 0 1\n0 0 0 0\n";
  refused("a\n", 2, "the file ends where '*' (an object) or '.' (the end) after the scene's name in the first line");
  refused("a\n* b\n1\n" + sphere, 9, "the file ends");
  refused("a\n+ b\n.\n", 2, "expected '*'");
  refused("a\n*\n1\n" + sphere + ".\n", 3, "has no name");
  refused("a\n* cart\n1\n" + sphere + ".\n", 3, "name of a link");
  refused("a\n* b\n1\n" + sphere + "* b\n1\n" + sphere + ".\n", 10, "given twice");
  refused("a\n* b\n0\n.\n", 3, "no shapes");
  refused("a\n* b\n-1\n.\n", 3, "whole number");
  refused("a\n* b\n1000000\n.\n", 3, "the rest of the file is shorter");
  refused("a\n* b\n1\ntorus\n", 4, "unknown shape 'torus'");
  refused("a\n* b\n1\nsphere\n-1\n.\n", 5, "radius");
  refused("a\n* b\n1\nsphere\nnan\n.\n", 5, "finite number");
  refused("a\n* b\n1\nsphere\n1\n0 0 0\n0 0 0 0\n", 7, "quaternion is zero");
  refused("a\n* b\n1\nsphere\n1\n0 0 0\n0 0 0 1\n2 0 0 0\n", 8, "from 0 to 1");
  refused("a\n* b\n1\nplane\n0 0 0 1\n", 5, "no direction");
  refused("a\n* b\n1\nmesh\n3 1\n0 0 0\n0 0 1\n0 1 0\n0 1 3\n", 9, "out of range");
  refused("a\n* b\n1\nmesh\n4000000000 1\n", 5, "the rest of the file is shorter");
  refused("a\n* b\n1\n" + sphere + "2\ntip\n0 0 0\n0 0 0 1\ntip\n0 0 0\n0 0 0 1\n.\n", 15,
          "subframe 'tip' is given twice");
  EXPECT_NE(std::string::npos,
            errorOf([&] { loadSceneFile(folder_.path("b.scene"), sliderRobot(), {}, nullptr); }).find("cannot read"));
}

TEST_F(SceneText, AnEmptyFileIsSaidToBeEmpty)
{
  for (const char* text : {"", "\n", " \n\t\r\n"})
  {
    const std::string message = errorOf([&] { load(text); });
    EXPECT_NE(std::string::npos, message.find("a.scene: the file is empty")) << message;
  }
}

TEST_F(SceneText, AFileOfAnotherFormatSaysWhatIsExpected)
{
  const std::string expected = "expected '*' (an object) or '.' (the end) after the scene's name in the first line";
  const std::string format = "has the text format of RViz's MotionPlanning plugin, without comments; give a YAML file";
  for (const char* text : {"# a comment\n# another one\n", "name: a\nworld: {}\n", "* a\n0 0 0\n0 0 0 1\n"})
  {
    refused(text, 2, expected);
    refused(text, 2, format);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
