// Octomaps that come at 2 Hz while states are checked.

#include <algorithm>
#include <atomic>
#include <map>
#include <set>
#include <thread>

#include "gpu_planning_scene/octomap.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class Octomaps : public RunningNode
{
 public:
  /// An octomap with 10,000 leaves far from the robot, and a leaf of `size` metres around `place`.
  static PlanningSceneMessage octomapAt(const Eigen::Vector3d& place, double size)
  {
    std::vector<PlacedShape> cubes;
    const auto add = [&](double x, double y) {
      cubes.push_back(
          {Box{Eigen::Vector3d::Constant(size)}, Eigen::Isometry3d(Eigen::Translation3d(x, y, 0.5 * size))});
    };
    add(0.5 * size, 0.5 * size);
    const int first = static_cast<int>(100.0 / size);
    for (int i = 0; i < 100; ++i)
      for (int j = 0; j < 100; ++j)
        add((first + i + 0.5) * size, (j + 0.5) * size);
    const SerializedOctree octree = octreeOf(cubes);
    PlanningSceneMessage message = diffScene();
    OctomapWithPose& map = message.world.octomap;
    map.octomap.id = octree.id;
    map.octomap.binary = 1;
    map.octomap.resolution = octree.resolution;
    map.octomap.data = octree.bytes;
    map.origin = poseAt(Eigen::Vector3d(place - Eigen::Vector3d::Constant(0.5 * size)));
    return message;
  }

  /// The number of voxels in the report.
  static double voxels()
  {
    const GetReport::Response report = call<GetReport>("get_report", {});
    const auto found = std::find(report.names.begin(), report.names.end(), "voxels");
    EXPECT_NE(report.names.end(), found);
    return found == report.names.end() ? -1.0 : report.values[static_cast<std::size_t>(found - report.names.begin())];
  }
};

TEST_F(Octomaps, AtTwoHertzGiveEachRevisionItsVerdict)
{
  constexpr double kSize = 0.02;
  const PlanningSceneMessage hit = octomapAt(tipPoint(), kSize);
  const PlanningSceneMessage miss = octomapAt(farAway(), kSize);
  std::map<std::uint64_t, bool> is_free;  // by revision
  is_free[apply(miss)] = true;
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> answered{0};  // the newest revision with an answer
  std::vector<std::pair<std::uint64_t, bool>> answers;
  std::thread client(
      [&]
      {
        while (!done)
        {
          const CheckStates::Response response = check(free_state);
          EXPECT_TRUE(response.success) << response.message;
          answers.emplace_back(response.scene_revision, !response.valid.empty() && response.valid[0] != 0);
          answered = response.scene_revision;
        }
      });
  for (int i = 0; i < 10; ++i)
  {
    const std::uint64_t revision = apply(i % 2 == 0 ? hit : miss);
    is_free[revision] = i % 2 != 0;
    for (int waited = 0; waited < 5 || (answered < revision && waited < 300); ++waited)
      ros::WallDuration(0.1).sleep();
  }
  done = true;
  client.join();
  EXPECT_EQ(11U, is_free.size()) << "each octomap is a revision";
  std::set<std::uint64_t> seen;
  for (const auto& [revision, free] : answers)
  {
    ASSERT_EQ(1U, is_free.count(revision)) << revision;
    EXPECT_EQ(is_free[revision], free) << "revision " << revision;
    seen.insert(revision);
  }
  EXPECT_GE(seen.size(), 10U) << "the services answer meanwhile";
}

TEST_F(Octomaps, GoThroughTheTopicAndComeBackAndAreCleared)
{
  const PlanningSceneMessage hit = octomapAt(tipPoint(), 0.02);
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<PlanningSceneMessage>(name("planning_scene"), 1);
  for (int i = 0; i < 200 && (publisher.getNumSubscribers() == 0 || isFree()); ++i)
  {
    publisher.publish(hit);
    ros::WallDuration(0.1).sleep();
  }
  // The octomap may also touch a neighbour of the tip.
  EXPECT_EQ(0U, collision().find(kOctomapId)) << collision();
  const PlanningSceneMessage back = scene();
  EXPECT_TRUE(back.world.collision_objects.empty());
  EXPECT_EQ(hit.world.octomap.octomap.data, back.world.octomap.octomap.data);
  EXPECT_EQ(hit.world.octomap.octomap.resolution, back.world.octomap.octomap.resolution);
  EXPECT_EQ(10001.0, voxels());
  PlanningSceneMessage clear = diffScene();
  clear.world.octomap.octomap.id = "cleared";
  apply(clear);
  EXPECT_TRUE(isFree());
  EXPECT_TRUE(scene().world.octomap.octomap.data.empty());
  EXPECT_EQ(0.0, voxels());
}

TEST_F(Octomaps, AreClearedByTheServiceWhichKeepsTheObjects)
{
  PlanningSceneMessage hit = octomapAt(tipPoint(), 0.02);
  hit.world.collision_objects.push_back(boxObject("beside", farAway(), 0.1));
  const std::uint64_t revision = apply(hit);
  EXPECT_FALSE(isFree());
  const Clear::Response cleared = call<Clear>("clear_octomap", {});
  EXPECT_TRUE(cleared.success) << cleared.message;
  EXPECT_GT(cleared.scene_revision, revision);
  EXPECT_TRUE(isFree());
  EXPECT_TRUE(scene().world.octomap.octomap.data.empty());
  EXPECT_EQ(1u, scene().world.collision_objects.size());
  EXPECT_TRUE(call<Clear>("clear_octomap", {}).success) << "a scene without an octomap";
}
}  // namespace
}  // namespace gpu_planning_scene::core
