// Tests the pixels of pictures that a software device renders.

#include <fstream>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "render/renderer.h"
#include "scene/slider_robot.h"
#include "support/software_device.h"
#include "tools/run_program.h"

namespace gpu_planning_scene::core
{
namespace
{
using Render = OnSoftwareDevice;
using RenderTool = OnSoftwareDevice;

constexpr int kWidth = 320;
constexpr int kHeight = 240;

std::vector<double> cartAt(const PlanningScene& scene, double x)
{
  std::vector<double> state = scene.robot->defaultState();
  state[static_cast<std::size_t>(scene.robot->variableIndex("slide"))] = x;
  return state;
}

Image pictureOf(const PlanningScene& scene, const std::vector<double>& state,
                const std::vector<Eigen::Vector3d>& contacts = {})
{
  return render(scene, state.data(), collidingPairs(scene, state.data()), contacts,
                viewsOf(scene, state.data(), Eigen::Vector3d::UnitZ())[0], kWidth, kHeight, "software");
}

using IsColor = bool (*)(int red, int green, int blue);
bool isRed(int red, int green, int blue)
{
  return red > 60 && red > 3 * green && red > 3 * blue;
}
bool isBrightRed(int red, int green, int blue)
{
  return isRed(red, green, blue) && red > 150;
}
bool isYellow(int red, int green, int blue)
{
  return red > 100 && 10 * green > 7 * red && 3 * blue < red;
}
bool isBackgroundOrFloor(int red, int green, int blue)
{
  return blue > 130 && blue >= red && 10 * red > 9 * blue && 10 * green > 9 * blue;
}
bool isShadedFloor(int red, int green, int blue)
{
  return isBackgroundOrFloor(red, green, blue) && blue < 215;
}
bool isTan(int red, int green, int blue)
{
  return 10 * red > 13 * blue && red >= green && green > blue;
}

bool isViolet(int red, int green, int blue)
{
  return 10 * blue > 12 * green && 10 * red > 11 * green && blue > red;
}

/// The share of the pixels for which `is_color` is true.
double shareOf(const Image& image, IsColor is_color)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    count += is_color(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]) ? 1 : 0;
  return 3.0 * static_cast<double>(count) / static_cast<double>(image.rgb.size());
}

TEST_F(Render, BodiesThatCollideAreRedAndNoOthers)
{
  const PlanningScene scene = sliderAndWall();
  const Image free = pictureOf(scene, cartAt(scene, 0.0));
  EXPECT_EQ(free.rgb.size(), 3u * kWidth * kHeight);
  EXPECT_EQ(shareOf(free, isRed), 0.0);
  EXPECT_LT(shareOf(free, isBackgroundOrFloor), 0.97) << "nothing is drawn";
  EXPECT_GT(shareOf(free, isBackgroundOrFloor), 0.3) << "the camera is inside of something";
  const Image hit = pictureOf(scene, cartAt(scene, 0.9));
  EXPECT_GT(shareOf(hit, isRed), 0.02);
}

TEST_F(Render, TrianglesThatBoundNoSolidAreVioletUnlessTheirBodyCollides)
{
  PlanningScene scene(sliderRobotOfMeshes());
  const std::vector<double> state = scene.robot->defaultState();
  const auto picture = [&](const std::vector<BodyPair>& colliding)
  {
    return render(scene, state.data(), colliding, {}, viewsOf(scene, state.data(), Eigen::Vector3d::UnitZ())[0], kWidth,
                  kHeight, "software");
  };
  const int pole = scene.robot->linkIndex("pole");  // lacks a side
  EXPECT_GT(shareOf(picture({}), isViolet), 0.005);
  const Image hit = picture({{pole, pole}});
  EXPECT_EQ(shareOf(hit, isViolet), 0.0);
  EXPECT_GT(shareOf(hit, isRed), 0.005);
  scene.robot = scene.robot->withSolids({{"pole", SolidRule::Filled}});
  EXPECT_EQ(shareOf(picture({}), isViolet), 0.0);
}

TEST_F(Render, TheSameSceneGivesTheSamePicture)
{
  const PlanningScene scene = sliderAndWall();
  const std::vector<double> state = cartAt(scene, 0.5);
  const Image first = pictureOf(scene, state);
  EXPECT_EQ(first.rgb, pictureOf(scene, state).rgb);
  EXPECT_NE(first.rgb, pictureOf(scene, cartAt(scene, 0.4)).rgb);
}

TEST_F(Render, ContactPointsAreYellow)
{
  const PlanningScene scene = sliderAndWall();
  const std::vector<double> state = cartAt(scene, 0.0);
  EXPECT_EQ(shareOf(pictureOf(scene, state), isYellow), 0.0);
  EXPECT_GT(shareOf(pictureOf(scene, state, {Eigen::Vector3d(0.1, 0.0, 0.2)}), isYellow), 0.0);
}

TEST_F(Render, HiddenContactPointsAreFaintAndNearOnesAreNot)
{
  const PlanningScene scene = sliderAndWall();
  const std::vector<double> state = cartAt(scene, 0.0);
  Camera camera;
  camera.eye = Eigen::Vector3d(3.0, 0.0, 0.0);
  camera.target = Eigen::Vector3d(1.0, 0.0, 0.0);
  // The side of the wall towards the camera is at x = 1.1 m, the other side at 0.9 m.
  const auto picture_of = [&](const std::vector<Eigen::Vector3d>& contacts)
  { return render(scene, state.data(), {}, contacts, camera, kWidth, kHeight, "software"); };
  const auto yellow_at = [&](double x) { return shareOf(picture_of({{x, 0.0, 0.0}}), isYellow); };
  EXPECT_GT(yellow_at(1.15), 0.0) << "before the wall";
  EXPECT_GT(yellow_at(1.09), 0.0) << "in the wall, near its surface";
  EXPECT_EQ(yellow_at(0.8), 0.0) << "behind the wall";
  EXPECT_NE(picture_of({{0.8, 0.0, 0.0}}).rgb, picture_of({}).rgb) << "faint, but visible";
}

TEST_F(Render, CollidingLinksThatAnObjectHidesAreFaint)
{
  const PlanningScene scene = sliderAndWall();
  const std::vector<double> state = cartAt(scene, 0.0);
  const int cart = scene.robot->linkIndex("cart");
  const int wall = static_cast<int>(scene.robot->links().size());
  const auto picture_from = [&](double x, const std::vector<BodyPair>& colliding)
  {
    Camera camera;
    camera.eye = Eigen::Vector3d(x, 0.0, 0.0);
    camera.target = Eigen::Vector3d(0.0, 0.0, 0.0);
    return render(scene, state.data(), colliding, {}, camera, kWidth, kHeight, "software");
  };
  // From x = 3 m, the wall hides the cart. In both pictures the wall collides, so only the cart differs.
  const Image behind = picture_from(3.0, {{cart, wall}});
  const Image alone = picture_from(3.0, {{wall, wall}});
  EXPECT_NE(behind.rgb, alone.rgb);
  EXPECT_EQ(shareOf(behind, isBrightRed), 0.0) << "faint";
  EXPECT_GT(shareOf(picture_from(-3.0, {{cart, wall}}), isBrightRed), 0.0) << "in front of the wall";
}

/// The same scene without grey bodies, which look like a shaded floor.
PlanningScene greenScene()
{
  PlanningScene scene = sliderAndWall();
  for (const char* name : {"cart", "pole", "wall"})
    scene.colors[name] = Color{0.1F, 0.8F, 0.1F, 1.0F};
  return scene;
}

TEST_F(Render, TheSceneStandsOnAFloorWithShadows)
{
  const PlanningScene scene = greenScene();
  const std::vector<double> state = cartAt(scene, 0.0);
  const double shaded = shareOf(pictureOf(scene, state), isShadedFloor);
  EXPECT_GT(shaded, 0.003);
  EXPECT_LT(shaded, 0.3);
  // From below, the floor would hide everything.
  Camera camera = viewsOf(scene, state.data(), Eigen::Vector3d::UnitZ())[0];
  camera.eye.z() = -camera.eye.z();
  const Image below = render(scene, state.data(), {{1, 2}}, {}, camera, kWidth, kHeight, "software");
  EXPECT_GT(shareOf(below, isRed), 0.0);
}

TEST_F(Render, TheClearestViewIsNotTheBackOfAShelf)
{
  PlanningScene scene = sliderAndWall();
  const std::vector<double> state = cartAt(scene, 0.0);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const auto red_in = [&](const Camera& camera) {
    return shareOf(render(scene, state.data(), {{1, 2}}, {}, camera, kWidth, kHeight, "software"), isRed);
  };
  const Camera front = viewsOf(scene, state.data(), up)[0];
  EXPECT_EQ(clearestView(scene, state.data(), {}, {}, up, "software").eye, front.eye) << "nothing hides the robot";
  WorldObject shelf;
  shelf.id = "shelf";
  shelf.pose.translation() = Eigen::Vector3d(0.5, -0.4, 0.3);
  shelf.pose.linear() = Eigen::AngleAxisd(-0.64, up).toRotationMatrix();
  shelf.shapes.push_back({Box{Eigen::Vector3d(0.02, 2.0, 2.0)}, Eigen::Isometry3d::Identity()});
  scene.objects.push_back(shelf);
  ASSERT_LT(red_in(viewsOf(scene, state.data(), up)[0]), 0.001);
  EXPECT_GT(red_in(clearestView(scene, state.data(), {}, {}, up, "software")), 0.005);
}

/// In the first view, a wall hides a small link, but not the large one.
TEST_F(Render, TheClearestViewShowsEachLink)
{
  const std::string urdf = R"(<robot name="r">
  <link name="body"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="tool"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="j" type="fixed"><parent link="body"/><child link="tool"/><origin xyz="-0.45 0.4 0.55"/></joint>
</robot>)";
  PlanningScene scene(RobotModel::fromXml(urdf, "", {}));
  WorldObject wall;
  wall.id = "wall";
  wall.pose.translation() = Eigen::Vector3d(0.1, 0.0, 0.8);
  wall.shapes.push_back({Box{Eigen::Vector3d(0.02, 1.0, 0.6)}, Eigen::Isometry3d::Identity()});
  scene.objects.push_back(wall);
  const std::vector<double> state;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const std::vector<BodyPair> only_tool{{1, 1}};
  const auto red_in = [&](const Camera& camera)
  { return shareOf(render(scene, state.data(), only_tool, {}, camera, kWidth, kHeight, "software"), isRed); };
  ASSERT_LT(red_in(viewsOf(scene, state.data(), up)[0]), 1e-4);
  EXPECT_GT(red_in(clearestView(scene, state.data(), {}, {}, up, "software")), 1e-3);
}

TEST_F(Render, TheClearestViewShowsACollidingLinkThatAnAttachedObjectHidesFromTheFront)
{
  PlanningScene scene = sliderAndWall();
  const std::vector<double> state = cartAt(scene, 0.9);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const std::vector<BodyPair> colliding = collidingPairs(scene, state.data());
  ASSERT_FALSE(colliding.empty());
  AttachedObject plate;
  plate.object.id = "plate";
  plate.object.pose.translation() = Eigen::Vector3d(1.4, -0.4, 0.3);
  plate.object.pose.linear() = Eigen::AngleAxisd(-0.64, up).toRotationMatrix();
  plate.object.shapes.push_back({Box{Eigen::Vector3d(0.02, 2.0, 2.0)}, Eigen::Isometry3d::Identity()});
  plate.link = 0;
  scene.attached.push_back(plate);
  const auto red_in = [&](const Camera& camera)
  { return shareOf(render(scene, state.data(), colliding, {}, camera, kWidth, kHeight, "software"), isRed); };
  ASSERT_LT(red_in(viewsOf(scene, state.data(), up)[0]), 0.001);
  EXPECT_GT(red_in(clearestView(scene, state.data(), colliding, {}, up, "software")), 0.005);
}

TEST_F(Render, AHalfSpaceIsAPlaneBelowTheRobotInsteadOfTheFloor)
{
  PlanningScene scene = greenScene();
  scene.colors["floor"] = Color{0.9F, 0.8F, 0.4F, 1.0F};
  const std::vector<double> state = cartAt(scene, 0.0);
  const double without = shareOf(pictureOf(scene, state), isTan);
  WorldObject floor;
  floor.id = "floor";
  floor.shapes.push_back({HalfSpace{Eigen::Vector3d::UnitZ(), -0.3}, Eigen::Isometry3d::Identity()});
  scene.objects.push_back(floor);
  EXPECT_GT(shareOf(pictureOf(scene, state), isTan), without + 0.03);
  EXPECT_LT(shareOf(pictureOf(scene, state), isShadedFloor), 0.003) << "smoothed edges alone";
}

TEST_F(Render, NearBodiesHideFarBodies)
{
  const PlanningScene scene = sliderAndWall();
  const std::vector<double> state = cartAt(scene, 0.9);
  const auto red_seen_from = [&](double x)
  {
    Camera camera;
    camera.eye = Eigen::Vector3d(x, 0.0, 0.0);
    camera.target = Eigen::Vector3d(1.0, 0.0, 0.0);
    // Only the cart is red. The wall, 1 m wide, hides it from one side and not from the other.
    return shareOf(render(scene, state.data(), {{1, 1}}, {}, camera, kWidth, kHeight, "software"), isRed);
  };
  ASSERT_EQ(scene.bodyName(1), "cart");
  EXPECT_GT(red_seen_from(-1.0), 0.0);
  EXPECT_EQ(red_seen_from(3.0), 0.0);
}

TEST_F(Render, CamerasAndSizesThatGiveNoPictureAreRefused)
{
  const PlanningScene scene = sliderAndWall();
  const std::vector<double> state = cartAt(scene, 0.0);
  const auto attempt = [&](const Camera& camera, int width)
  { return errorOf([&] { render(scene, state.data(), {}, {}, camera, width, kHeight, "software"); }); };
  Camera camera;
  camera.eye = Eigen::Vector3d(0.0, 0.0, 5.0);
  camera.target = Eigen::Vector3d::Zero();
  EXPECT_NE(attempt(camera, kWidth).find("--camera"), std::string::npos);
  camera.eye = camera.target;
  EXPECT_NE(attempt(camera, kWidth).find("--camera"), std::string::npos);
  camera.eye = Eigen::Vector3d(1.0, 1.0, 1.0);
  for (const int width : {0, -1, 5000})
    EXPECT_NE(attempt(camera, width).find("from 1 to 4096"), std::string::npos) << width;
  EXPECT_NE(errorOf(
                [] {
                  writePng(Image{1, 1, {0, 0, 0}}, "/no/such/folder/a.png");
                })
                .find("/no/such/folder"),
            std::string::npos);
}

TEST_F(RenderTool, WritesAPngAndNamesWhatCollides)
{
  const TemporaryFolder folder;
  const std::string out = folder.path("picture.png");
  const std::string scenes = std::string(GPS_SOURCE_DIR) + "/test/";
  const auto run = [&](const std::vector<std::string>& more)
  {
    std::vector<std::string> arguments{"--urdf",   scenes + "scene/slider.urdf",
                                       "--srdf",   scenes + "scene/slider.srdf",
                                       "--scene",  scenes + "node/wall_scene.yaml",
                                       "--device", "software",
                                       "--size",   "64x48",
                                       "--out",    out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(GPS_RENDER, arguments);
  };
  const ProgramOutput free = run({"--state", "slide=0"});
  EXPECT_EQ(free.exit_code, 0) << free.err;
  EXPECT_NE(free.err.find("free of collision"), std::string::npos) << free.err;
  EXPECT_NE(free.err.find("collision shapes, not visual meshes"), std::string::npos) << free.err;
  std::ifstream file(out, std::ios::binary);
  std::string head(24, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  EXPECT_EQ(head.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(head.substr(16), std::string("\0\0\0\x40\0\0\0\x30", 8)) << "its size";

  const ProgramOutput hit = run({"--state", "slide=0.9,turn=0.5"});
  EXPECT_NE(hit.err.find("collides: cart - wall"), std::string::npos) << hit.err;
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--state", "lift=1"},
                                                {"--state", "slide"},
                                                {"--state", "slide=x"},
                                                {"--camera", "1,2"},
                                                {"--up", "0,0,0"},
                                                {"--object", "a"},
                                                {"--out", "a.jpg"},
                                                {"--out", ".png"},
                                                {"--out", "a"},
                                                {"--object", "a=b.stl,1,2"}})
    EXPECT_EQ(run(wrong).exit_code, 2) << wrong[0] << " " << wrong[1];
}

TEST_F(RenderTool, MeshFilesBecomeObjects)
{
  const TemporaryFolder folder;
  const std::string mesh = folder.write("part.obj", "v 0 -1 -1\nv 0 1 -1\nv 0 0 1\nf 1 2 3\n");
  const auto run = [&](const std::string& object)
  {
    return runProgram(GPS_RENDER, {"--urdf", std::string(GPS_SOURCE_DIR) + "/test/scene/slider.urdf", "--device",
                                   "software", "--size", "64x48", "--out", folder.path("a.png"), "--object", object});
  };
  EXPECT_NE(run("part=" + mesh).err.find("collides: cart - part"), std::string::npos);
  EXPECT_NE(run("part=" + mesh + ",0.55,0,0").err.find("free of collision"), std::string::npos);
  // Rotated about z by a right angle, the part extends from x = 0.05 to 1.05 at the cart's height.
  const ProgramOutput turned = run("part=" + mesh + ",0.55,0,0,0,0,0.70710678,0.70710678");
  EXPECT_NE(turned.err.find("collides: cart - part"), std::string::npos) << turned.err;
  EXPECT_EQ(run("part=" + folder.path("none.obj")).exit_code, 1);
}
}  // namespace
}  // namespace gpu_planning_scene::core
