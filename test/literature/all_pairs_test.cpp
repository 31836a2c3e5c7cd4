// The methods that find all pairs of triangles find the pairs that testing each pair finds.

#include <gtest/gtest.h>

#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"
#include "literature/method.h"
#include "literature/models.h"
#include "literature/poses.h"
#include "literature/trees/triangle_overlap.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Poses = std::vector<Eigen::Isometry3d>;

double workOf(const Method& method, const std::string& what)
{
  for (const auto& [name, count] : method.work())
    if (name == what)
      return count;
  throw std::logic_error("no work of this name: " + what);
}

const MethodInfo& named(const std::vector<MethodInfo>& methods, const std::string& name)
{
  return *std::find_if(
      methods.begin(), methods.end(), [&](const MethodInfo& info) { return info.name == name; });
}

/// Poses from deep overlap to a clearance.
Poses manyPoses()
{
  Poses poses;
  for (const double distance : {0.1, 0.5, 0.8, 2.0})
    for (const Eigen::Isometry3d& pose : posesAt(distance, 5, 2))
      poses.push_back(pose);
  return poses;
}

/// The number of colliding pairs of triangles at each pose, by testing every pair.
std::vector<std::size_t> counted(const Mesh& a, const Mesh& b, const Poses& poses)
{
  std::vector<std::size_t> counts;
  for (const Eigen::Isometry3d& pose : poses)
  {
    counts.push_back(0);
    for (const Triangle& s : trianglesOf(a))
      for (const Triangle& t : trianglesOf(b))
        counts.back() += trianglesOverlap(s, moved(t, pose.linear(), pose.translation())) ? 1 : 0;
  }
  return counts;
}

void expectAllPairs(const MethodInfo& info, double share)
{
  const Model a = madeModel("torus", 300, 1);
  const Model b = madeModel("lump", 400, 1);
  const Poses poses = manyPoses();
  const std::vector<std::size_t> expected = counted(*a.mesh, *b.mesh, poses);
  const auto total = static_cast<double>(std::accumulate(expected.begin(), expected.end(), std::size_t{0}));
  ASSERT_GT(total, 500.0);
  ASSERT_EQ(expected.back(), 0U) << "the farthest pose is free";
  const auto method = info.make(a.mesh, b.mesh);
  const std::vector<std::uint8_t> answers = method->collide(poses);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(answers[i] != 0, expected[i] > 0) << info.name << ", pose " << i;
  EXPECT_NEAR(workOf(*method, "pairs of triangles"), total, share * total) << info.name;
}
}  // namespace

TEST(AllPairs, AreFoundOnTheCpu)
{
  const std::vector<MethodInfo> methods = treeMethods();
  for (const char* name : {"rapid_all", "breadth_first_all"})
    expectAllPairs(named(methods, name), 0.0);
}

// In float32, a pair of triangles that nearly touch may get another answer.
TEST(AllPairs, AreFoundOnTheDevice)
{
  expectAllPairs(deviceMethods().front(), 1e-3);
}

TEST(AllPairs, TheDeviceTestsTheBoxesThatTheCpuTests)
{
  const Model model = madeModel("lump", 2000, 1);
  const Poses poses = posesAt(0.7, 50, 1);
  const auto cpu = named(treeMethods(), "breadth_first_all").make(model.mesh, model.mesh);
  const auto device = deviceMethods().front().make(model.mesh, model.mesh);
  EXPECT_EQ(cpu->collide(poses), device->collide(poses));
  const double expected = workOf(*cpu, "volume tests");
  EXPECT_NEAR(workOf(*device, "volume tests"), expected, 1e-3 * expected);
}

TEST(AllPairs, TheTimesOfTestsAndListsAreMeasuredApart)
{
  const Model model = madeModel("lump", 300, 1);
  const Poses poses = posesAt(0.7, 5, 1);
  for (const MethodInfo& info : {named(treeMethods(), "breadth_first"), deviceMethods().front()})
  {
    const auto method = info.make(model.mesh, model.mesh);
    const WorkCounts parts = method->timesOfParts(poses);
    ASSERT_EQ(parts.size(), 2U);
    for (const auto& [name, microseconds] : parts)
      EXPECT_GT(microseconds, 0.0) << info.name << ", " << name;
  }
}
}  // namespace gpu_planning_scene::core::literature
