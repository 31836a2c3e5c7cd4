// The map of sensors has the world's surfaces within a voxel, follows the world within three measurements, and never
// has the robot. The peers are depth images of known scenes, and FCL.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/occupancy_map.h"
#include "model/model_testing.h"
#include "support/depth_camera.h"
#include "support/fcl_peer.h"
#include "support/moving_shape.h"
#include "support/repetitions.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kResolution = 0.04;
const PinholeCamera kCamera{320, 240, 280.0, 280.0, 159.5, 119.5};

/// Metres: the distance of a point from the surfaces of the boxes of the world.
double distanceFromWorld(const PlanningScene& scene, const Vector3d& point)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const WorldObject& object : scene.objects)
    nearest = std::min(nearest, distanceFromSurface(object, point));
  return nearest;
}

/// Metres: the largest difference of a coordinate between a point and the nearest centre of a cube.
double distanceFromCubes(const std::vector<PlacedShape>& cubes, const Vector3d& point)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const PlacedShape& cube : cubes)
    nearest = std::min(nearest, (cube.pose.translation() - point).cwiseAbs().maxCoeff());
  return nearest;
}

/// Whether the robot or its attached objects touch a cube, by FCL.
bool touchesRobot(const PlanningScene& scene, const std::vector<double>& state, const std::vector<PlacedShape>& cubes)
{
  PlanningScene with_cubes(scene.robot);
  with_cubes.attached = scene.attached;
  with_cubes.objects = {{"cubes", Isometry3d::Identity(), cubes}};
  auto problem = makeProblem(with_cubes, "", nullptr);
  problem.self_pairs.clear();
  FclPeer peer(std::make_shared<const CollisionProblem>(std::move(problem)));
  std::vector<Isometry3d> link_poses(scene.robot->links().size());
  scene.robot->linkPoses(state.data(), link_poses.data());
  peer.setState(link_poses.data());
  return peer.firstCollision().has_value();
}

/// A robot that carries a rod and moves on a floor, beside a wall and a crate, before two noisy cameras.
class Cell
{
 public:
  explicit Cell(const std::string& robot_of) : test_(testScene(robot_of)), truth_(test_.scene->robot)
  {
    truth_.objects = {boxAt("floor", {0.0, 0.0, -0.1137}, {4.0, 4.0, 0.2}),
                      boxAt("wall", {0.2, 1.513, 0.8}, {2.4, 0.1, 1.8}),
                      boxAt("crate", {1.031, -0.5, 0.25}, {0.3, 0.3, 0.5})};
    const int last = static_cast<int>(truth_.robot->links().size()) - 1;
    truth_.attached.push_back({boxAt("rod", {0.0, 0.0, 0.2}, {0.04, 0.3, 0.04}), last});
    states_ = test_.randomStates(100, 7);
    state_ = stateOf(0);
  }

  /// One image of each camera, while the robot moves on.
  void measure(OccupancyMap& map)
  {
    for (const Vector3d& eye : {Vector3d(1.9, 0.6, 1.7), Vector3d(-1.2, -1.7, 1.4)})
    {
      time_ += 1.0 / 15.0;
      moveOn();
      const Isometry3d pose = cameraPose(eye, {0.2, 0.0, 0.4});
      DepthImage image = depthImageOf(truth_, state_.data(), kCamera, pose);
      addNoise(image, {0.001, 0.005}, generator_);
      PlanningScene known(truth_.robot);  // the node does not know the world
      known.attached = truth_.attached;
      map.add(image, {pose, time_, time_}, known, state_.data());
    }
  }

  void expectTruth(OccupancyMap& map)
  {
    const std::vector<PlacedShape> cubes = map.cubes(truth_, state_.data()).cubes;
    EXPECT_FALSE(touchesRobot(truth_, state_, cubes));
    std::size_t invented = 0;
    for (const PlacedShape& cube : cubes)
      if (distanceFromWorld(truth_, cube.pose.translation()) > (1.0 + 0.5 * std::sqrt(3.0)) * kResolution)
        ++invented;
    EXPECT_EQ(0u, invented) << "of " << cubes.size() << " cubes";
    EXPECT_EQ(0u, missing(cubes));
  }

  PlanningScene& truth() { return truth_; }
  const std::vector<double>& state() const { return state_; }

 private:
  std::vector<double> stateOf(std::size_t row) const
  {
    const std::size_t width = truth_.robot->variables().size();
    const auto begin = states_.begin() + static_cast<std::ptrdiff_t>(row % 100 * width);
    return {begin, begin + static_cast<std::ptrdiff_t>(width)};
  }

  /// A fifth of the motion to the next random state, whatever is there.
  void moveOn()
  {
    const std::vector<double> to = stateOf(step_ / 5 + 1);
    const std::vector<double> from = stateOf(step_ / 5);
    const double share = static_cast<double>(step_ % 5) / 5.0;
    for (std::size_t i = 0; i < to.size(); ++i)
      state_[i] = from[i] + share * (to[i] - from[i]);
    ++step_;
  }

  /// The number of points of the world, in sight of the first camera and away from the robot, that have no cube within
  /// a voxel.
  std::size_t missing(const std::vector<PlacedShape>& cubes)
  {
    const Isometry3d pose = cameraPose({1.9, 0.6, 1.7}, {0.2, 0.0, 0.4});
    const DepthImage image = depthImageOf(truth_, state_.data(), kCamera, pose);
    constexpr int kPixels = repetitions(11, 7);  // between two points
    std::size_t count = 0;
    for (int y = 3; y < kCamera.height; y += kPixels)
      for (int x = 3; x < kCamera.width; x += kPixels)
      {
        const Vector3d point = pose * pointOf(image, x, y);
        if (!point.allFinite() || distanceFromWorld(truth_, point) > 1e-4)
          continue;
        // The robot's own surroundings are left out.
        PlanningScene ball(truth_.robot);
        ball.attached = truth_.attached;
        ball.objects = {{"ball", Isometry3d(Eigen::Translation3d(point)), {{Sphere{0.03 + 3.0 * kResolution}}}}};
        if (distanceFromCubes(cubes, point) > 1.5 * kResolution && !touchesRobot(ball, state_, ball.objects[0].shapes))
          ++count;
      }
    return count;
  }

  const TestScene& test_;
  PlanningScene truth_;
  std::vector<double> states_;
  std::vector<double> state_;
  std::mt19937_64 generator_{11};
  std::size_t step_ = 0;
  double time_ = 0.0;
};

class OccupancyMapOf : public testing::TestWithParam<std::string>
{
};

TEST_P(OccupancyMapOf, ARobotAtWorkHasTheWorldAndNeverTheRobot)
{
  if (const std::string missing = missingFor(GetParam()); !missing.empty())
    GTEST_SKIP() << missing << " is missing";
  Cell cell(GetParam());
  OccupancyMapOptions options;
  options.resolution = kResolution;
  OccupancyMap map(options);
  for (int i = 0; i < 4; ++i)
  {
    cell.measure(map);
    cell.expectTruth(map);
  }
  cell.truth().objects.pop_back();  // the crate
  for (int i = 0; i < 3; ++i)
    cell.measure(map);
  cell.expectTruth(map);
}
INSTANTIATE_TEST_SUITE_P(Robots, OccupancyMapOf,
                         testing::Values("arm_boxes", "kr5_boxes", "panda_boxes", "ur5_table_pick"),
                         [](const auto& test) { return test.param; });

/// A map of voxels of 0.1 m before a camera at the origin that looks along x, and a robot whose link is a cube of 1 m.
class OccupancyMapOfACamera : public testing::Test
{
 protected:
  static constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

  OccupancyMapOfACamera()
    : scene_(robotOf("<link name=\"base\"/>" + boxLink("tip") + jointXml("move", "floating", "base", "tip")))
  {
    options_.resolution = 0.1;
    view_.sensor = cameraPose({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
  }

  /// All pixels have this depth, except those of the middle quarter.
  std::size_t see(OccupancyMap& map, float depth, float middle)
  {
    DepthImage image{{64, 48, 60.0, 60.0, 31.5, 23.5}, std::vector<float>(std::size_t{64} * 48, depth)};
    for (std::size_t y = 12; y < 36; ++y)
      std::fill_n(image.depths.begin() + static_cast<std::ptrdiff_t>(64 * y + 16), 32, middle);
    view_.time += 1.0;
    view_.received += 1.0;
    return map.add(image, view_, scene_, state_.data(), left_out_);
  }

  bool isOccupied(OccupancyMap& map, const Vector3d& point)
  {
    return distanceFromCubes(map.cubes(scene_, state_.data()).cubes, point) < 0.05;
  }

  void placeTip(const Vector3d& place) { std::copy_n(place.data(), 3, state_.begin()); }

  PlanningScene scene_;
  std::vector<double> state_ = {100, 100, 100, 0, 0, 0, 1};
  OccupancyMapOptions options_;
  SensorView view_;
  std::set<std::string> left_out_;
};

TEST_F(OccupancyMapOfACamera, LosesAVoxelAfterAsManyViewsBehindItAsHitsAndThreeAtMost)
{
  for (const int hits : {1, 2, 3, 7})
  {
    OccupancyMap map(options_);
    for (int i = 0; i < hits; ++i)
      see(map, 4.05F, 2.05F);
    for (int i = 0; i < std::min(hits, 3); ++i)
    {
      EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05})) << hits << " hits, after " << i;
      see(map, 4.05F, 4.05F);
    }
    EXPECT_FALSE(isOccupied(map, {2.05, 0.05, 0.05})) << hits << " hits";
    EXPECT_TRUE(isOccupied(map, {4.05, 0.05, 0.05}));
  }
}

TEST_F(OccupancyMapOfACamera, KeepsVoxelsThatItDoesNotSee)
{
  OccupancyMap map(options_);
  see(map, 4.05F, 3.05F);
  for (int i = 0; i < 5; ++i)
    see(map, 4.05F, 2.05F);
  EXPECT_TRUE(isOccupied(map, {3.05, 0.05, 0.05})) << "hidden by a nearer surface";
  const std::size_t before = map.size();
  for (int i = 0; i < 5; ++i)
    see(map, 4.05F, kNaN);
  EXPECT_EQ(before, map.size()) << "in a patch that is not measured, and at its border";
  for (int i = 0; i < 5; ++i)
    see(map, 4.05F, -1.0F);
  EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05})) << "behind a thing that is too close";
  view_.min_range = 0.5;
  for (int i = 0; i < 5; ++i)
    see(map, 4.05F, 0.3F);
  EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05})) << "behind a thing that is nearer than the range";
  EXPECT_FALSE(isOccupied(map, {0.25, 0.05, 0.05})) << "nearer than the range";
}

TEST_F(OccupancyMapOfACamera, LosesAllVoxelsOfAThingThatLeavesTheImage)
{
  for (const float depth : {0.95F, 1.55F, 2.05F, 3.3F})
  {
    OccupancyMap map(options_);
    see(map, depth, depth);  // the voxels at the border of the image too
    EXPECT_GT(map.size(), 0u);
    see(map, 20.0F, 20.0F);
    EXPECT_EQ(0u, map.size()) << depth << " m";
  }
}

TEST_F(OccupancyMapOfACamera, KeepsAVoxelThatItOnceSawWholeWhenItSeesBehindAPartOfIt)
{
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  // The voxel is at the right border of the image now, its centre still inside. It may hold a wire that is outside.
  const double turned = std::atan2(0.05, 2.05) + std::atan2(62.5 - 31.5, 60.0);
  view_.sensor = cameraPose({0.0, 0.0, 0.0}, {std::cos(turned), std::sin(turned), 0.0});
  for (int i = 0; i < 5; ++i)
    see(map, 4.05F, 4.05F);
  EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05}));
  view_.sensor = cameraPose({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
  see(map, 4.05F, 4.05F);
  EXPECT_FALSE(isOccupied(map, {2.05, 0.05, 0.05})) << "seen whole again";
}

TEST_F(OccupancyMapOfACamera, TakesAnIsolatedPointOfACloudWhoseVoxelIsSeenThroughAnotherFace)
{
  OccupancyMap map(options_);
  view_.sensor = Isometry3d(Eigen::Translation3d(0.02, 0.0, 0.0));
  // The point is seen through the face in the direction of x, and the centre of its voxel through that of y.
  map.add(std::vector<Vector3f>{{1.07F, 1.06F, 0.05F}}, view_, scene_, state_.data());
  EXPECT_TRUE(isOccupied(map, {1.05, 1.05, 0.05}));
}

TEST_F(OccupancyMapOfACamera, SeesAsFarAsItsRange)
{
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  view_.max_range = 3.0;
  see(map, 4.05F, std::numeric_limits<float>::infinity());
  EXPECT_FALSE(isOccupied(map, {2.05, 0.05, 0.05})) << "a ray that meets nothing sees through the voxel";
  EXPECT_TRUE(isOccupied(map, {4.05, 1.55, 0.05})) << "not within the range";
  see(map, 3.5F, 3.5F);
  EXPECT_FALSE(isOccupied(map, {3.55, 0.05, 0.05})) << "not within the range";
}

TEST_F(OccupancyMapOfACamera, TakesNoVoxelAwayThatALaterMeasurementHasHit)
{
  OccupancyMap map(options_);
  view_.time = 10.0;
  see(map, 4.05F, 2.05F);  // at 11 s
  view_.time = 9.5;
  see(map, 4.05F, 4.05F);  // of a slow camera, at 10.5 s
  EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05}));
  view_.time = 1.0;
  see(map, 4.05F, 4.05F);  // the clock was set back
  EXPECT_FALSE(isOccupied(map, {2.05, 0.05, 0.05}));
}

TEST_F(OccupancyMapOfACamera, ForgetsAfterTheDecayAndStaysInTheRegion)
{
  options_.decay = 5.0;
  options_.region = {Vector3d(0.0, -1.0, -1.0), Vector3d(10.0, 1.0, 1.0)};
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  EXPECT_TRUE(isOccupied(map, {4.05, 0.95, 0.95}));
  EXPECT_FALSE(isOccupied(map, {4.05, 1.55, 0.05})) << "outside the region";
  for (int i = 0; i < 5; ++i)
    see(map, 1.05F, 1.05F);
  EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05}));
  see(map, 1.05F, 1.05F);
  EXPECT_FALSE(isOccupied(map, {2.05, 0.05, 0.05})) << "not hit for 6 s";
}

TEST_F(OccupancyMapOfACamera, KeepsAVoxelThatTheRobotApproaches)
{
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  placeTip({1.48, 0.0, 0.0});  // its front is at 1.98, and the voxels begin at 2.0
  see(map, 4.05F, 1.0F);
  EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05})) << "within the padding, but known before";
  EXPECT_FALSE(isOccupied(map, {1.05, 0.05, 0.05})) << "a point of the robot";
}

TEST_F(OccupancyMapOfACamera, KeepsThePartsOfAVoxelThatTheRobotDoesNotTouch)
{
  const auto collides = [this](const std::vector<PlacedShape>& cubes, double x)
  {
    placeTip({x, 0.0, 0.0});
    return touchesRobot(scene_, state_, cubes);
  };
  const auto tip_at = [this](OccupancyMap& map, double x)
  {
    placeTip({x, 0.0, 0.0});
    return map.cubes(scene_, state_.data());
  };
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  const std::size_t whole = tip_at(map, 50.0).cubes.size();
  EXPECT_TRUE(tip_at(map, 50.0).are_whole);
  for (const double padding : {0.0, 0.01})
  {
    scene_.link_padding = {padding, padding};
    const VoxelCubes touched = tip_at(map, 1.53);  // its front is at 2.03, and the voxels go from 2.0 to 2.1
    EXPECT_FALSE(touched.are_whole);
    EXPECT_FALSE(collides(touched.cubes, 1.53 + padding + 0.0009)) << "it is free of what is left by its padding";
    EXPECT_TRUE(collides(touched.cubes, 1.53 + 0.0259)) << "further in, it meets what is left";
    EXPECT_FALSE(collides(touched.cubes, 1.48)) << "it can leave";
  }
  scene_.link_padding.clear();
  const VoxelCubes through = tip_at(map, 1.65);
  EXPECT_FALSE(through.are_whole);
  EXPECT_FALSE(collides(through.cubes, 1.65)) << "behind the voxels, nothing is left of them";
  EXPECT_EQ(whole, tip_at(map, 50.0).cubes.size()) << "the robot has left";
  EXPECT_EQ(whole, map.cubes(scene_, nullptr).cubes.size()) << "the robot's place is not known";
}

TEST_F(OccupancyMapOfACamera, LetsTheRobotLeaveAVoxelByItsPadding)
{
  const double padding = 0.02;
  scene_.link_padding = {padding, padding};
  const auto cubes_at = [this](OccupancyMap& map, const Vector3d& tip)
  {
    placeTip(tip);
    return map.cubes(scene_, state_.data());
  };
  /// Whether the tip meets a cube on its way from one place to another one.
  const auto meets = [this](const std::vector<PlacedShape>& cubes, const Vector3d& tip)
  {
    placeTip(tip);
    return touchesRobot(scene_, state_, cubes);
  };
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  // Its front is at 2.03 m, and the voxels go from 2 to 2.1 m. Its upper end is 5 mm below voxels that it does not
  // touch.
  const Vector3d inside{1.53, -0.005, 0.0};
  const VoxelCubes touched = cubes_at(map, inside);
  EXPECT_FALSE(meets(touched.cubes, inside + Vector3d(0.0, padding, 0.0))) << "voxels beside those that it touches";
  // On its way out, its front is 5 mm before the voxels.
  const Vector3d outside{1.495, -0.005, 0.0};
  const VoxelCubes left = cubes_at(map, outside);
  EXPECT_FALSE(left.are_whole);
  EXPECT_FALSE(meets(left.cubes, outside + Vector3d(padding, 0.0, 0.0)));
  EXPECT_TRUE(cubes_at(map, {1.47, -0.005, 0.0}).are_whole) << "it has left";
  EXPECT_TRUE(cubes_at(map, outside).are_whole) << "coming from outside, it is too near to whole voxels";
}

TEST_F(OccupancyMapOfACamera, KeepsLargerPartsWhereTheSceneHasNoRoomForSmallOnes)
{
  OccupancyMap unlimited(options_);
  see(unlimited, 4.05F, 2.05F);
  placeTip({1.53, 0.0, 0.0});
  const std::size_t parts = unlimited.cubes(scene_, state_.data()).cubes.size();
  for (const std::size_t limit : {unlimited.size() * 10 / 9 + 1, parts - 1, 10 * parts})
  {
    options_.max_voxels = limit;
    OccupancyMap map(options_);
    placeTip({100.0, 100.0, 100.0});
    EXPECT_EQ(0u, see(map, 4.05F, 2.05F));
    placeTip({1.53, 0.0, 0.0});
    const VoxelCubes cubes = map.cubes(scene_, state_.data());
    EXPECT_LE(cubes.cubes.size(), limit);
    EXPECT_FALSE(cubes.are_whole);
    EXPECT_EQ(limit >= parts, cubes.has_all_parts);
    EXPECT_EQ(limit < parts, touchesRobot(scene_, state_, cubes.cubes)) << "no part is given up";
  }
}

TEST_F(OccupancyMapOfACamera, SplitsNoVoxelsThatAnOctreeOfSmallerCubesDoesNotReach)
{
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  placeTip({1.53, 0.0, 0.0});
  EXPECT_FALSE(touchesRobot(scene_, state_, map.cubes(scene_, state_.data()).cubes));
  SensorView far = view_;
  far.sensor.translation().x() = 1000.0;  // the octree of quarters reaches 819 m
  map.add(std::vector<Eigen::Vector3f>{{1.0F, 0.0F, 0.0F}}, far, scene_, state_.data());
  const VoxelCubes cubes = map.cubes(scene_, state_.data());
  EXPECT_TRUE(touchesRobot(scene_, state_, cubes.cubes));
  double smallest = 1.0;
  for (const PlacedShape& cube : cubes.cubes)
    smallest = std::min(smallest, std::get<Box>(cube.shape).size.x());
  EXPECT_EQ(0.05, smallest);
}

TEST_F(OccupancyMapOfACamera, LeavesOutNamedObjectsAndAnObjectThatIsAttached)
{
  scene_.objects = {boxAt("part", {2.25, 0.0, 0.0}, {0.4, 1.0, 1.0})};
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05})) << "other objects do not count";
  left_out_ = {"part", "no such object"};
  see(map, 4.05F, 2.05F);
  EXPECT_FALSE(isOccupied(map, {2.05, 0.05, 0.05}));
  EXPECT_TRUE(isOccupied(map, {4.05, 1.55, 0.05}));

  left_out_ = {};
  see(map, 4.05F, 2.05F);
  ASSERT_TRUE(isOccupied(map, {2.05, 0.05, 0.05}));
  scene_.attached.push_back({scene_.objects[0], 0});
  scene_.objects.clear();
  map.removeNear({"part"}, view_.padding, scene_, state_.data());
  scene_.attached[0].object.pose.translation().x() = 50.0;
  EXPECT_FALSE(isOccupied(map, {2.05, 0.05, 0.05})) << "its voxels do not stay behind when it is carried away";

  scene_.attached.clear();
  scene_.objects = {{"floor", Isometry3d::Identity(), {{HalfSpace{Vector3d::UnitZ(), 0.0}}}}};
  left_out_ = {"floor"};
  EXPECT_NE(errorOf([&] { see(map, 4.05F, 2.05F); }).find("'floor' has a half-space"), std::string::npos);
}

TEST_F(OccupancyMapOfACamera, KeepsVoxelsThatACarriedObjectComesNearEvenIfItIsNamed)
{
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  scene_.attached.push_back({boxAt("part", {1.7, 0.0, 0.0}, {0.5, 1.0, 1.0}), 0});  // 5 cm before the voxels
  left_out_ = {"part"};
  view_.padding = 0.1;
  see(map, 4.05F, 1.45F);
  EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05}));
  EXPECT_FALSE(isOccupied(map, {1.45, 0.05, 0.05})) << "a point of the part";
}

TEST_F(OccupancyMapOfACamera, DoesNotForgetAnObstacleThatIsMeasuredBesideTheRobot)
{
  options_.decay = 5.0;
  OccupancyMap map(options_);
  see(map, 4.05F, 2.05F);
  placeTip({1.48, 0.0, 0.0});  // its front is at 1.98, and the voxels begin at 2.0
  for (int i = 0; i < 20; ++i)
    see(map, 4.05F, 2.05F);
  EXPECT_TRUE(isOccupied(map, {2.05, 0.05, 0.05}));
}

TEST_F(OccupancyMapOfACamera, TakesTheNearestVoxelsWhenThereIsNoRoomForAll)
{
  options_.max_voxels = 700;
  OccupancyMap map(options_);
  EXPECT_EQ(0u, see(map, 2.05F, 2.05F));
  const std::size_t before = map.size();
  EXPECT_GT(see(map, 4.05F, 1.05F), 0u);
  EXPECT_EQ(630u, map.size()) << "a tenth of the room is for parts of voxels";
  EXPECT_TRUE(isOccupied(map, {1.05, 0.05, 0.05})) << "a new obstacle near the camera";
  EXPECT_LT(before, 700u);
  see(map, 20.0F, 20.0F);
  EXPECT_EQ(0u, map.size()) << "there is room again";
}

TEST_F(OccupancyMapOfACamera, AFullMapGivesFarVoxelsUpForANearObstacle)
{
  OccupancyMap whole(options_);
  see(whole, 3.05F, 3.05F);
  options_.max_voxels = 10 * whole.size() / 9 + 1;
  OccupancyMap map(options_);
  EXPECT_EQ(0u, see(map, 3.05F, 3.05F));
  EXPECT_GT(see(map, 3.05F, 1.05F), 0u);
  EXPECT_TRUE(isOccupied(map, {1.05, 0.05, 0.05}));
  EXPECT_EQ(options_.max_voxels - options_.max_voxels / 10, map.size());
}

TEST_F(OccupancyMapOfACamera, RefusesWrongArguments)
{
  OccupancyMap map(options_);
  const auto error_of = [&](const DepthImage& image)
  { return errorOf([&] { map.add(image, view_, scene_, state_.data()); }); };
  EXPECT_NE(error_of({{4, 3, 1.0, 1.0, 0.0, 0.0}, std::vector<float>(11)}).find("11 depths, but 4 x 3 pixels"),
            std::string::npos);
  EXPECT_NE(error_of({{1, 1, 0.0, 1.0, 0.0, 0.0}, {1.0F}}).find("focal lengths"), std::string::npos);
  view_.max_range = 0.0;
  EXPECT_NE(error_of({{1, 1, 1.0, 1.0, 0.0, 0.0}, {1.0F}}).find("the range"), std::string::npos);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL})
  {
    OccupancyMapOptions options;
    options.resolution = bad;
    EXPECT_THROW(OccupancyMap{options}, Error);
  }
  options_.region = {Vector3d(1.0, 0.0, 0.0), Vector3d(0.0, 1.0, 1.0)};
  EXPECT_THROW(OccupancyMap{options_}, Error);
}

TEST_F(OccupancyMapOfACamera, KeepsAThinThingThatItCannotMeasure)
{
  // A pole is measured once. Afterwards, its column of pixels has no depth.
  OccupancyMap map(options_);
  DepthImage image{{64, 48, 60.0, 60.0, 31.5, 23.5}, std::vector<float>(std::size_t{64} * 48, 4.05F)};
  const auto set_column = [&](float depth)
  {
    for (std::size_t y = 0; y < 48; ++y)
      image.depths[64 * y + 30] = depth;
  };
  set_column(2.05F);
  map.add(image, view_, scene_, state_.data());
  const std::size_t before = map.size();
  set_column(kNaN);
  for (int i = 0; i < 5; ++i)
    map.add(image, view_, scene_, state_.data());
  EXPECT_EQ(before, map.size());
}

TEST_F(OccupancyMapOfACamera, TakesPointsOfAVoxelThatReachesTheCamera)
{
  OccupancyMap map(options_);
  view_.sensor = cameraPose({1.02, 0.05, 0.05}, {2.0, 0.05, 0.05});
  see(map, 4.05F, 0.03F);
  EXPECT_TRUE(isOccupied(map, {1.05, 0.05, 0.05}));
}

TEST_F(OccupancyMapOfACamera, KeepsAVoxelBetweenTheRowsOfAScanner)
{
  // Rows of points 2 degrees apart pass above and below a small voxel.
  options_.resolution = 0.02;
  OccupancyMap map(options_);
  view_.sensor = at(0.0, 0.0, 0.0);
  map.add(std::vector<Vector3f>{{3.0F, 0.05F, 0.06F}}, view_, scene_, state_.data());
  ASSERT_EQ(1u, map.size());
  std::vector<Vector3f> rows;
  for (const float degrees : {-1.0F, 0.0F, 1.7F})
    for (int i = -200; i <= 200; ++i)
      rows.push_back(8.0F * Vector3f(1.0F, 0.001F * static_cast<float>(i), std::tan(degrees * 0.0174533F)));
  for (int i = 0; i < 5; ++i)
    map.add(rows, view_, scene_, state_.data());
  EXPECT_TRUE(isOccupied(map, {3.01, 0.05, 0.07}));
}

TEST_F(OccupancyMapOfACamera, SeesThroughNoVoxelBeyondTheRangeOfAScanner)
{
  OccupancyMap map(options_);
  view_.sensor = at(0.0, 0.0, 0.0);
  std::vector<Vector3f> wall;
  for (int y = -200; y <= 200; ++y)
    for (int z = -200; z <= 200; ++z)
      wall.emplace_back(8.0F, 0.01F * static_cast<float>(y), 0.01F * static_cast<float>(z));
  const std::vector<Vector3f> points = {{2.05F, 0.05F, 0.05F}, {4.05F, 0.05F, 0.05F}};
  map.add(points, view_, scene_, state_.data());
  view_.max_range = 3.0;
  map.add(wall, view_, scene_, state_.data());
  EXPECT_FALSE(isOccupied(map, {2.05, 0.05, 0.05}));
  EXPECT_TRUE(isOccupied(map, {4.05, 0.05, 0.05}));
}

TEST_F(OccupancyMapOfACamera, TakesCloudsFromAllDirections)
{
  const std::uint64_t seed = 3;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  std::normal_distribution<float> normal;
  view_.sensor = at(0.3, -0.2, 0.1);
  std::vector<Vector3f> sphere;
  for (int i = 0; i < 200'000; ++i)
    sphere.push_back(Vector3f(normal(generator), normal(generator), normal(generator)).normalized());
  const auto scaled = [&](float radius)
  {
    std::vector<Vector3f> points;
    for (const Vector3f& point : sphere)
      points.emplace_back(radius * point);
    points.emplace_back(kNaN, 0.0F, 0.0F);
    return points;
  };
  OccupancyMap map(options_);
  map.add(scaled(1.0F), view_, scene_, state_.data());
  const std::size_t inner = map.size();
  for (const PlacedShape& cube : map.cubes(scene_, state_.data()).cubes)
    EXPECT_NEAR((cube.pose.translation() - view_.sensor.translation()).norm(), 1.0, 0.05 * std::sqrt(3.0) + 1e-6);
  map.add(scaled(2.0F), view_, scene_, state_.data());
  EXPECT_GT(map.size(), 3 * inner);
  for (const PlacedShape& cube : map.cubes(scene_, state_.data()).cubes)
    EXPECT_NEAR((cube.pose.translation() - view_.sensor.translation()).norm(), 2.0, 0.05 * std::sqrt(3.0) + 1e-6)
        << "the voxels of the inner sphere are seen through";
}
}  // namespace
}  // namespace gpu_planning_scene::core
