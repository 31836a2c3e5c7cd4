// The voxels of the sensors in the scene follow the robot and its objects between two measurements.

#include <limits>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "model/model_testing.h"
#include "node/sensors/sensed_map.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;
using Eigen::Vector3f;

/// A robot that moves a cube of 1 m along x, before a scanner that has measured three walls.
class SensedMapOfAScanner : public testing::Test
{
 protected:
  SensedMapOfAScanner()
  {
    options_.resolution = 0.1;
    std::vector<Vector3f> points;
    for (const float x : {0.05F, 2.05F, 5.05F})
      for (int i = -5; i < 5; ++i)
        points.emplace_back(x, 0.1F * static_cast<float>(i) + 0.05F, 0.05F);
    place(100.0);
    map_.add(points, SensorView(), store_.snapshot().state);
  }

  void place(double x) { store_.updateState({{"move", x}}); }

  std::size_t voxelsAt(double x) const
  {
    std::size_t count = 0;
    if (const WorldObject* octomap = store_.snapshot().scene->findObject(kOctomapId))
      for (const PlacedShape& cube : octomap->shapes)
        count += std::abs(cube.pose.translation().x() - x) < 0.05 ? 1 : 0;
    return count;
  }

  /// Adds a box at a wall, and attaches it to the cube.
  void grasp(double x)
  {
    SceneChange change;
    change.is_diff = true;
    AttachedChange& part = change.state.attached.emplace_back();
    part.link = "tip";
    part.object.id = "part";
    part.object.pose = Eigen::Isometry3d::Identity();
    part.object.frame.name = "tip";  // which is at 100
    part.object.shapes = {{Box{Vector3d(0.2, 2.0, 1.0)}, Eigen::Isometry3d(Eigen::Translation3d(x - 100.0, 0.0, 0.0))}};
    store_.apply(change, [](const StampedFrame&) { return Eigen::Isometry3d::Identity(); });
  }

  OccupancyMapOptions options_;
  SceneStore store_{
      PlanningScene(robotOf("<link name=\"base\"/>" + boxLink("tip") +
                            jointXml("move", "prismatic", "base", "tip",
                                     "<limit lower=\"-200\" upper=\"200\" effort=\"1\" velocity=\"1\"/>"))),
      {},
      {}};
  SensedMap map_{store_, options_, 0.03};
};

TEST_F(SensedMapOfAScanner, AnAttachedObjectLosesTheVoxelsOfThePlaceWhereItWasAttached)
{
  ASSERT_EQ(10u, voxelsAt(2.05));
  grasp(2.05);
  place(103.0);  // the part is at the other wall before the map hears of it
  map_.republish();
  EXPECT_EQ(0u, voxelsAt(2.05));
  place(150.0);
  map_.republish();
  EXPECT_EQ(10u, voxelsAt(5.05)) << "the part was only carried past";
}

TEST_F(SensedMapOfAScanner, AnObjectThatIsAttachedToARobotInAnUnknownStateRemovesNoVoxels)
{
  EXPECT_THROW(place(std::numeric_limits<double>::quiet_NaN()), Error);
  grasp(2.05);
  place(100.0);
  map_.republish();
  EXPECT_EQ(10u, voxelsAt(2.05));
}

TEST_F(SensedMapOfAScanner, VoxelsAreWholeWhileTheRobotsPlaceIsNotKnown)
{
  place(2.0);
  map_.add(std::vector<Vector3f>(), SensorView(), store_.snapshot().state);
  EXPECT_NE(10u, voxelsAt(2.05)) << "the robot is there";
  EXPECT_THROW(place(std::numeric_limits<double>::quiet_NaN()), Error);
  map_.republish();
  EXPECT_EQ(10u, voxelsAt(2.05));
  EXPECT_EQ(10u, voxelsAt(0.05)) << "the joint's default value";
  place(2.0);
  map_.republish();
  EXPECT_NE(10u, voxelsAt(2.05));
}
}  // namespace
}  // namespace gpu_planning_scene::core
