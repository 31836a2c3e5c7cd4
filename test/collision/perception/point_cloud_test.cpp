// The object of a point cloud contains every point except the robot's own points.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/point_cloud.h"
#include "model/model_testing.h"
#include "support/carrying_scene.h"
#include "support/moving_shape.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

bool holds(const WorldObject& object, const Vector3d& point)
{
  return std::any_of(
      object.shapes.begin(), object.shapes.end(),
      [&](const PlacedShape& cube)
      {
        const Vector3d half = 0.5 * std::get<Box>(cube.shape).size;
        const Vector3d local = object.pose * cube.pose.translation() - point;
        return (local.cwiseAbs() - half).maxCoeff() < 1e-9;
      });
}

/// A robot far from the points of the tests.
PlanningScene farRobot()
{
  return PlanningScene(robotOf("<link name=\"base\"/>" + boxLink("tip") + jointXml("move", "floating", "base", "tip")));
}

const std::vector<double> kFarAway = {100, 100, 100, 0, 0, 0, 1};

TEST(PointCloud, IsACubeForEachVoxelWithAPoint)
{
  PointCloudFilter filter({0.1, 0.0, 100.0});
  const PlanningScene scene = farRobot();
  // The points lie on both sides of the origin and on a border of voxels. Two points are in one voxel.
  const std::vector<Vector3f> points = {{0.05F, 0.05F, 0.05F},  {0.09F, 0.01F, 0.02F}, {-0.05F, 0.0F, 0.05F},
                                        {-0.05F, -1.0F, 7.03F}, {0.5F, 0.25F, -0.3F},  {3.0F, 4.0F, -5.0F}};
  const WorldObject object = filter.objectOf("cloud", points, Isometry3d::Identity(), scene, kFarAway.data());
  EXPECT_EQ(object.id, "cloud");
  EXPECT_EQ(object.shapes.size(), 5u);
  for (const Vector3f& point : points)
    EXPECT_TRUE(holds(object, point.cast<double>())) << point.transpose();
  EXPECT_FALSE(holds(object, {0.15, 0.05, 0.05}));
}

TEST(PointCloud, HoldsItsPointsWhereverTheSensorIs)
{
  const std::uint64_t seed = 29;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<float> place(-2.0F, 2.0F);
  const PlanningScene scene = farRobot();
  for (const double voxel : {0.3, 0.05})
  {
    PointCloudFilter filter({voxel, 0.0, 100.0});
    const Isometry3d sensor = randomPose(generator, 500.0);
    std::vector<Vector3f> points;
    for (int i = 0; i < 200; ++i)
      points.emplace_back(place(generator), place(generator), place(generator));
    const WorldObject object = filter.objectOf("cloud", points, sensor, scene, kFarAway.data());
    for (const Vector3f& point : points)
      EXPECT_TRUE(holds(object, sensor * point.cast<double>()));
  }
}

TEST(PointCloud, LeavesOutPointsThatAreNotFiniteOrOutOfRange)
{
  PointCloudFilter filter({0.1, 0.0, 2.0});
  const PlanningScene scene = farRobot();
  const float nan = std::nanf("");
  const std::vector<Vector3f> points = {{nan, 0, 0}, {0, HUGE_VALF, 0}, {0, 0, 2.1F}, {0, 0, 1.9F}};
  const WorldObject object = filter.objectOf("cloud", points, at(50, 0, 0), scene, kFarAway.data());
  ASSERT_EQ(object.shapes.size(), 1u);
  EXPECT_TRUE(holds(object, {50.0, 0.0, 1.9}));
  EXPECT_TRUE(filter.objectOf("cloud", {}, at(0, 0, 0), scene, kFarAway.data()).shapes.empty());
}

TEST(PointCloud, OfTooManyVoxelsOrWithWrongOptionsIsRefused)
{
  const PlanningScene scene = farRobot();
  PointCloudFilter filter({0.1, 0.0, 10.0, 2});
  const std::vector<Vector3f> points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_NE(errorOf([&] { filter.objectOf("cloud", points, at(0, 0, 0), scene, kFarAway.data()); })
                .find("fills 3 voxels, but at most 2 are allowed"),
            std::string::npos);
  EXPECT_THROW(filter.objectOf("cloud", {}, at(std::nan(""), 0, 0), scene, kFarAway.data()), Error);
  EXPECT_THROW(filter.objectOf("cloud", points, at(1e9, 0, 0), scene, kFarAway.data()), Error);
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL})
  {
    EXPECT_THROW(PointCloudFilter({bad, 0.0, 10.0}), Error);
    EXPECT_THROW(PointCloudFilter({0.1, bad, 10.0}), Error);
    EXPECT_THROW(PointCloudFilter({0.1, 0.0, bad}), Error);
  }
  EXPECT_THROW(PointCloudFilter({0.0, 0.0, 10.0}), Error);
}

/// Points on the shapes' surfaces, with a random error of up to `noise` along each axis.
std::vector<Vector3f> pointsOn(const std::vector<PlacedShape>& shapes, const Isometry3d& pose, float noise,
                               std::mt19937_64& generator)
{
  std::uniform_real_distribution<float> off(-noise, noise);
  std::vector<Vector3f> points;
  for (const PlacedShape& placed : shapes)
  {
    const Tessellation surface = tessellate(placed.shape);
    for (const Vector3d& vertex : surface.mesh->vertices)
      points.push_back((pose * placed.pose * vertex).cast<float>() +
                       Vector3f(off(generator), off(generator), off(generator)));
  }
  return points;
}

TEST(PointCloud, PointsOnTheRobotAndItsAttachedObjectsAreRemoved)
{
  const TestScene& test = testScene("arm_boxes");
  PlanningScene scene = *test.scene;
  scene.objects.clear();
  const RobotModel& robot = *scene.robot;
  const std::uint64_t seed = 31;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  const int last = static_cast<int>(robot.links().size()) - 1;
  scene.attached.push_back({{"carried", at(0, 0, 0.3), {{Box{{0.05, 0.4, 0.05}}}}}, last, {}});
  // The padding of links and attached objects must not remove more points.
  scene.attached[0].padding = 2.0;
  scene.link_padding.assign(robot.links().size(), 0.5);
  PointCloudFilter filter({0.02, 0.03, 10.0});
  for (int k = 0; k < 5; ++k)
  {
    std::vector<double> state(robot.variables().size());
    robot.randomState(generator, state.data());
    std::vector<Isometry3d> poses(robot.links().size());
    robot.linkPoses(state.data(), poses.data());
    std::vector<Vector3f> points =
        pointsOn(scene.attached[0].object.shapes, poses.back() * scene.attached[0].object.pose, 0.01F, generator);
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
      const auto more = pointsOn(robot.links()[i].shapes, poses[i], 0.01F, generator);
      points.insert(points.end(), more.begin(), more.end());
    }
    points.emplace_back(3.0F, 3.0F, 0.0F);
    const WorldObject object = filter.objectOf("cloud", points, at(0, 0, 0), scene, state.data());
    ASSERT_EQ(object.shapes.size(), 1u) << "what is far from the robot stays";
    EXPECT_TRUE(holds(object, {3.0, 3.0, 0.0}));
  }
}

TEST(PointCloud, ALinkMayHaveTheNameCloud)
{
  PlanningScene scene(robotOf(boxLink("cloud")));
  const std::vector<Vector3f> points = {{0.0F, 0.0F, 0.0F}, {3.0F, 0.0F, 0.0F}};
  const WorldObject object =
      PointCloudFilter({0.02, 0.03, 10.0}).objectOf("points", points, at(0, 0, 0), scene, nullptr);
  EXPECT_EQ(object.shapes.size(), 1u) << "the point in the link is removed";
}

TEST(PointCloud, PointsAreRemovedOnlyWithinTheRobotsPadding)
{
  const PlanningScene scene = farRobot();  // with a box link of 1 m
  const std::vector<double> state = {0, 0, 0, 0, 0, 0, 1};
  const double half = 0.5 * std::get<Box>(scene.robot->links()[1].shapes.at(0).shape).size.x();
  const float voxel = 0.01F;
  PointCloudFilter filter({voxel, 0.1, 10.0});
  const auto stays = [&](double distance)
  {
    const Vector3f point(static_cast<float>(half + distance), 0.005F, 0.005F);
    return !filter.objectOf("cloud", {point}, at(0, 0, 0), scene, state.data()).shapes.empty();
  };
  EXPECT_FALSE(stays(0.0));
  EXPECT_FALSE(stays(0.095));
  EXPECT_TRUE(stays(0.1 + voxel + 1e-4));
  EXPECT_TRUE(stays(1.0));
}

TEST(PointCloud, LeavesNoStateFreeThatAPointRefutes)
{
  const TestScene& test = testScene("arm_boxes");
  PlanningScene scene = *test.scene;
  scene.objects.clear();
  const std::size_t width = scene.robot->variables().size();
  const std::uint64_t seed = 37;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<float> place(-1.0F, 1.0F);
  std::vector<Vector3f> points;
  for (int i = 0; i < 400; ++i)
    points.emplace_back(place(generator), place(generator), 1.0F + place(generator));
  const Isometry3d sensor = at(0.1, -0.2, 0.3);
  const std::vector<double> start = scene.robot->defaultState();
  PointCloudFilter filter({0.03, 0.0, 10.0});
  scene.objects.push_back(filter.objectOf("cloud", points, sensor, scene, start.data()));
  CpuChecker with_cloud(std::make_shared<const PlanningScene>(scene));
  // The points as tiny spheres, except points within a voxel of the robot.
  PlanningScene exact = scene;
  exact.objects = {{"points", Isometry3d::Identity(), {}}};
  for (const Vector3f& point : points)
  {
    const Isometry3d there(Eigen::Translation3d(sensor * point.cast<double>()));
    if (holds(scene.objects[0], there.translation()))
    {
      exact.objects[0].shapes.push_back({Sphere{1e-9}, there});
      continue;
    }
    PlanningScene ball(scene.robot);
    ball.objects.push_back({"ball", there, {{Sphere{0.03 * std::sqrt(3.0) + 1e-6}}}});
    EXPECT_EQ(0, CpuChecker(std::make_shared<const PlanningScene>(ball)).check(start.data(), 1).valid[0])
        << "a point is lost that is not the robot's: " << there.translation().transpose();
  }
  EXPECT_GT(exact.objects[0].shapes.size(), 300u);
  CpuChecker with_points(std::make_shared<const PlanningScene>(exact));
  const std::vector<double> states = test.randomStates(1000, seed);
  const BatchResult cloud = with_cloud.check(states.data(), states.size() / width);
  const BatchResult each = with_points.check(states.data(), states.size() / width);
  std::size_t refuted = 0;
  std::size_t free = 0;
  for (std::size_t i = 0; i < cloud.valid.size(); ++i)
  {
    EXPECT_LE(cloud.valid[i], each.valid[i]) << i;
    refuted += each.valid[i] == 0 ? 1 : 0;
    free += cloud.valid[i];
  }
  EXPECT_GT(refuted, 50u);
  EXPECT_GT(free, 50u);
}
}  // namespace
}  // namespace gpu_planning_scene::core
