// Verdicts in scenes with an octomap are those of FCL's octrees.

#include <cassert>  // FCL 0.7 uses assert without it
#include <cmath>
#include <random>

#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "scene/random_octree.h"
#include "scene/slider_robot.h"
#include "support/moving_shape.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;

/// The octree among which the slider robot moves, at some pose.
class OctomapVerdicts : public testing::TestWithParam<std::uint64_t>
{
 protected:
  OctomapVerdicts() : generator_(GetParam()), octree_(std::make_shared<octomap::OcTree>(0.04))
  {
    fillAtRandom(*octree_, 0.8, 40, generator_);
    WorldObject object;
    object.id = kOctomapId;
    object.pose = randomPose(generator_, 0.2);
    object.shapes = occupiedLeaves(serialized(*octree_, GetParam() % 2 == 0), 100000);
    scene_.objects = {object};
  }

  std::vector<double> randomStates(std::size_t count)
  {
    std::uniform_real_distribution<double> slide(-1.0, 1.0);
    std::uniform_real_distribution<double> turn(-M_PI, M_PI);
    std::vector<double> states;
    for (std::size_t i = 0; i < count; ++i)
      states.insert(states.end(), {slide(generator_), turn(generator_)});
    return states;
  }

  /// The distance between the robot's boxes and the octree; 0 in collision.
  double distance(const double* state) const
  {
    std::vector<Isometry3d> poses(scene_.robot->links().size());
    scene_.robot->linkPoses(state, poses.data());
    const fcl::CollisionObjectd tree(std::make_shared<fcl::OcTreed>(octree_), scene_.objects[0].pose);
    double least = HUGE_VAL;
    for (std::size_t link = 0; link < poses.size(); ++link)
      for (const PlacedShape& placed : scene_.robot->links()[link].shapes)
      {
        const auto box = std::make_shared<fcl::Boxd>(std::get<Box>(placed.shape).size);
        const fcl::CollisionObjectd body(box, poses[link] * placed.pose);
        fcl::CollisionResultd contact;
        if (fcl::collide(&body, &tree, fcl::CollisionRequestd(), contact) != 0)
          return 0.0;
        fcl::DistanceResultd found;
        least = std::min(least, fcl::distance(&body, &tree, fcl::DistanceRequestd(), found));
      }
    return least;
  }

  std::mt19937_64 generator_;
  std::shared_ptr<octomap::OcTree> octree_;
  PlanningScene scene_{sliderRobot()};
};

TEST_P(OctomapVerdicts, AreThoseOfFclWithAndWithoutPadding)
{
  constexpr double kUnsure = 1e-4;  // metres: FCL's distances are less exact
  constexpr std::size_t kStates = 300;
  const std::vector<double> states = randomStates(kStates);
  std::vector<double> distances;
  for (std::size_t i = 0; i < kStates; ++i)
    distances.push_back(distance(&states[2 * i]));
  for (const double padding : {0.0, 0.03})
  {
    SCOPED_TRACE("padding " + std::to_string(padding));
    scene_.objects[0].padding = padding;
    CpuChecker checker(std::make_shared<const PlanningScene>(scene_));
    const BatchResult result = checker.check(states.data(), kStates);
    std::size_t free = 0;
    for (std::size_t i = 0; i < kStates; ++i)
    {
      const bool collides = distances[i] == 0.0 || distances[i] <= padding;
      if (distances[i] == 0.0 || std::abs(distances[i] - padding) > kUnsure)
        EXPECT_EQ(collides ? 0 : 1, result.valid[i]) << "state " << i << ", distance " << distances[i];
      free += result.valid[i];
    }
    EXPECT_GT(free, kStates / 20) << "the test has free states";
    EXPECT_LT(free, kStates - kStates / 20) << "the test has collisions";
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, OctomapVerdicts, testing::Values(1, 2, 3, 4));
}  // namespace
}  // namespace gpu_planning_scene::core
