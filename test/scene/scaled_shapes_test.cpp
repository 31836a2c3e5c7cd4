// The scale of links: primitives grow about their own origins, meshes about the mean of their vertices.

#include "scene/change_testing.h"
#include "scene/validate_scene.h"

namespace gpu_planning_scene::core
{
namespace
{
std::vector<double> factors(const RobotModel& robot, const std::string& link, double factor)
{
  std::vector<double> result(robot.links().size(), 1.0);
  result[static_cast<std::size_t>(robot.linkIndex(link))] = factor;
  return result;
}

const Link& linkOf(const RobotModel& robot, const std::string& name)
{
  return robot.links()[static_cast<std::size_t>(robot.linkIndex(name))];
}

TEST(ScaledShapes, PrimitivesGrowAboutTheirOwnOrigins)
{
  const auto robot = sliderRobot();
  const auto scaled = robot->scaled(factors(*robot, "pole", 2.0));
  const PlacedShape& pole = linkOf(*scaled, "pole").shapes.at(0);
  EXPECT_EQ(Eigen::Vector3d(0.2, 0.2, 0.8), std::get<Box>(pole.shape).size);
  EXPECT_EQ(0.5, pole.pose.translation().z()) << "its origin stays";
  EXPECT_EQ(0.2, std::get<Box>(linkOf(*scaled, "cart").shapes.at(0).shape).size.x());
  EXPECT_EQ(0.4, std::get<Box>(linkOf(*robot, "pole").shapes.at(0).shape).size.z()) << "the first robot is as it was";
}

TEST(ScaledShapes, EachKindOfShapeIsScaledInAllItsSizes)
{
  PlanningScene scene(sliderRobot());
  scene.setLinkScale(factors(*scene.robot, "cart", 3.0));
  const Mesh mesh{"mesh", {{1, 0, 0}, {4, 0, 0}, {1, 3, 0}}, {{0, 1, 2}}};
  AttachedObject carried;
  carried.link = scene.robot->linkIndex("cart");
  carried.object.id = "a";
  carried.object.shapes = {
      {Sphere{1.0}}, {Cylinder{1.0, 2.0}}, {Cone{2.0, 3.0}}, {std::make_shared<const Mesh>(mesh), poseAt(5, 0, 0)}};
  scene.scaleAttached(carried);
  const std::vector<PlacedShape>& shapes = carried.shapes();
  EXPECT_EQ(3.0, std::get<Sphere>(shapes[0].shape).radius);
  EXPECT_EQ(3.0, std::get<Cylinder>(shapes[1].shape).radius);
  EXPECT_EQ(6.0, std::get<Cylinder>(shapes[1].shape).length);
  EXPECT_EQ(6.0, std::get<Cone>(shapes[2].shape).radius);
  EXPECT_EQ(9.0, std::get<Cone>(shapes[2].shape).length);
  // The mean of the vertices is (2, 1, 0).
  const auto& vertices = std::get<std::shared_ptr<const Mesh>>(shapes[3].shape)->vertices;
  EXPECT_TRUE(vertices[0].isApprox(Eigen::Vector3d(-1, -2, 0), 1e-15));
  EXPECT_TRUE(vertices[1].isApprox(Eigen::Vector3d(8, -2, 0), 1e-15));
  EXPECT_TRUE(vertices[2].isApprox(Eigen::Vector3d(-1, 7, 0), 1e-15));
  EXPECT_EQ(5.0, shapes[3].pose.translation().x());
}

TEST(ScaledShapes, FactorsOfOneAreTheRobotAsItWasLoaded)
{
  const auto robot = sliderRobot();
  EXPECT_EQ(robot, robot->scaled({}));
  EXPECT_EQ(robot, robot->scaled(std::vector<double>(robot->links().size(), 1.0)));
  const auto twice = robot->scaled(factors(*robot, "pole", 2.0));
  EXPECT_EQ(twice, twice->scaled(factors(*robot, "pole", 2.0))) << "nothing is made anew where nothing changes";
  EXPECT_EQ(robot, twice->scaled({}));
  EXPECT_TRUE(robot->linkScale().empty());
}

TEST(ScaledShapes, FactorsAreOfTheRobotAsItWasLoaded)
{
  const auto robot = sliderRobot();
  const auto scaled = robot->scaled(factors(*robot, "pole", 2.0))->scaled(factors(*robot, "cart", 4.0));
  EXPECT_EQ(0.4, std::get<Box>(linkOf(*scaled, "pole").shapes.at(0).shape).size.z());
  EXPECT_EQ(0.8, std::get<Box>(linkOf(*scaled, "cart").shapes.at(0).shape).size.z());
}

TEST(ScaledShapes, EqualMeshesStayOneMesh)
{
  PlanningScene scene(sliderRobot());
  const PlacedShape mesh = triangleAt();
  AttachedObject carried;
  carried.link = scene.robot->linkIndex("cart");
  carried.object.id = "a";
  carried.object.shapes = {mesh, mesh};
  scene.attached = {carried, carried};
  scene.attached[1].object.id = "b";
  scene.setLinkScale(factors(*scene.robot, "cart", 3.0));
  const auto of = [&](std::size_t object, std::size_t shape)
  { return std::get<std::shared_ptr<const Mesh>>(scene.attached[object].shapes()[shape].shape); };
  EXPECT_EQ(of(0, 0), of(0, 1));
  EXPECT_EQ(of(0, 0), of(1, 1));
  scene.setLinkScale({});
  EXPECT_EQ(nullptr, scene.attached[0].scaled_shapes);
}

TEST(ScaledShapes, AttachedObjectsNeedTheScaleOfTheirLink)
{
  PlanningScene scene(sliderRobot());
  scene.setLinkScale(factors(*scene.robot, "cart", 3.0));
  AttachedObject carried;
  carried.link = scene.robot->linkIndex("cart");
  carried.object.id = "a";
  carried.object.shapes = {boxAt(0.1)};
  scene.attached = {carried};
  EXPECT_NE(std::string::npos, errorOf([&] { validateScene(scene); }).find("scaleAttached"));
  scene.scaleAttached(scene.attached[0]);
  EXPECT_NO_THROW(validateScene(scene));
}

TEST(ScaledShapes, AttachedObjectsWithAnEarlierScaleOrShapeAreRefused)
{
  PlanningScene scene(sliderRobot());
  std::vector<double> both = factors(*scene.robot, "cart", 1.2);
  both[static_cast<std::size_t>(scene.robot->linkIndex("pole"))] = 2.0;
  scene.setLinkScale(both);
  AttachedObject carried;
  carried.link = scene.robot->linkIndex("cart");
  carried.object.id = "a";
  const Mesh mesh{"mesh", {{1, 0, 0}, {4, 0, 0}, {1, 3, 0}}, {{0, 1, 2}}};
  carried.object.shapes = {{Sphere{1.0}}, {std::make_shared<const Mesh>(mesh)}};
  scene.scaleAttached(carried);
  scene.attached = {carried};
  EXPECT_EQ("", errorOf([&] { validateScene(scene); }));
  const auto refused = [&scene] { return errorOf([&] { validateScene(scene); }).find("its link's scale"); };
  scene.attached[0].link = scene.robot->linkIndex("pole");
  EXPECT_NE(std::string::npos, refused());
  scene.attached = {carried};
  scene.attached[0].object.shapes[0].shape = Sphere{5.0};
  EXPECT_NE(std::string::npos, refused());
}

TEST(ScaledShapes, WrongFactorsAreRefusedAndChangeNothing)
{
  PlanningScene scene(sliderRobot());
  const auto robot = scene.robot;
  const auto refused = [&](const std::vector<double>& wrong, const std::string& fragment)
  {
    EXPECT_NE(std::string::npos, errorOf([&] { scene.setLinkScale(wrong); }).find(fragment));
    EXPECT_EQ(robot, scene.robot);
  };
  refused({2.0}, "1 values for 5 links");
  refused(factors(*robot, "cart", 0.0), "link 'cart'");
  refused(factors(*robot, "cart", -1.0), "link 'cart'");
  refused(factors(*robot, "cart", std::numeric_limits<double>::infinity()), "link 'cart'");
  refused(factors(*robot, "cart", 1e-323), "link 'cart'");
}
}  // namespace
}  // namespace gpu_planning_scene::core
