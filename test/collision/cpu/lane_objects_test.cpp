// Boxes around the objects of the lane kernel.

#include <random>

#include <gtest/gtest.h>

#include "collision/cpu/lanes/lane_objects.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// How much farther a point within the reach is from the box than from the half-space, in metres, at most.
double mostOverestimated(const Vector3d& normal, double offset, double reach)
{
  CollisionProblem problem;
  problem.half_spaces = {{0, normal, offset, 0.0}};
  const CpuForest forest(problem, nullptr);
  const std::vector<LaneObject> objects = laneObjects(problem, forest, Vector3d::Zero());
  const Eigen::AlignedBox3d box = boundsWithin(objects.front(), reach);
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> uniform(-reach / 2.0, reach / 2.0);
  double most = -reach;
  for (int i = 0; i < 2000; ++i)
  {
    const Vector3d point(uniform(generator), uniform(generator), uniform(generator));
    const double distance = std::max(0.0, normal.dot(point) - offset);
    most = std::max(most, box.exteriorDistance(point) - distance);
  }
  return most;
}

TEST(LaneObjects, ABoxIsNotFartherAwayThanATiltedHalfSpace)
{
  for (const double tilt : {0.0, 1e-30, 1e-9, 1e-6, 5e-5, 2.4e-4, 1e-2, 0.5, 1.5})
    for (const double sign : {1.0, -1.0})
      for (const int axis : {0, 1, 2})
      {
        Vector3d normal = Vector3d::Zero();
        normal[axis] = sign * std::cos(tilt);
        normal[(axis + 1) % 3] = std::sin(tilt);
        EXPECT_LE(mostOverestimated(normal, 0.1, 2.0), 1e-7) << "tilt " << tilt << ", axis " << axis;
        EXPECT_LE(mostOverestimated(normal, -5.0, 2.0), 1e-7) << "tilt " << tilt << ", axis " << axis;
      }
}

TEST(LaneObjects, AFloorLeavesBodiesHighAboveItOut)
{
  CollisionProblem problem;
  problem.half_spaces = {{0, Vector3d::UnitZ(), 0.1, 0.0}};
  const CpuForest forest(problem, nullptr);
  const Eigen::AlignedBox3d box = boundsWithin(laneObjects(problem, forest, Vector3d::Zero()).front(), 2.0);
  EXPECT_NEAR(box.exteriorDistance(Vector3d(1.0, -1.0, 0.6)), 0.5, 1e-7);
}
}  // namespace
}  // namespace gpu_planning_scene::core
