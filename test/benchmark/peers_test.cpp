// The peers give correct answers for the same robot. Otherwise the comparison would be worthless.

#include <gtest/gtest.h>

#include "benchmark/sphere_fit.h"
#include "collision/bounds/problem_maker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "support/fcl_peer.h"
#include "support/generated_arm.h"
#include "support/obstacles.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kStates = 300;

/// FCL's answers for random states of the scene.
std::vector<std::uint8_t> fclAnswers(const TestScene& scene, FclTree tree, FclOrder order = FclOrder::Fixed)
{
  const RobotModel& robot = *scene.scene->robot;
  const FclPeer original(std::make_shared<const CollisionProblem>(makeProblem(*scene.scene, "", nullptr)), tree, order);
  FclPeer peer(original);  // each thread uses a copy, so the copy is tested
  const std::vector<double> states = scene.randomStates(kStates, 1);
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  std::vector<std::uint8_t> valid;
  for (std::size_t i = 0; i < kStates; ++i)
  {
    robot.linkPoses(&states[i * robot.variables().size()], poses.data());
    peer.setState(poses.data());
    valid.push_back(peer.firstCollision() ? 0 : 1);
  }
  return valid;
}

std::vector<std::uint8_t> exactAnswers(const TestScene& scene)
{
  return CpuChecker(scene.scene).check(scene.randomStates(kStates, 1).data(), kStates).valid;
}

/// The largest distance from a vertex to the nearest ball.
double uncovered(const Mesh& mesh, const std::vector<benchmark::Ball>& balls)
{
  double most = 0.0;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
  {
    double least = 1e9;
    for (const benchmark::Ball& ball : balls)
      least = std::min(least, (vertex - ball.center.cast<double>()).norm() - ball.radius);
    most = std::max(most, least);
  }
  return most;
}
}  // namespace

TEST(FclTrees, AllGiveTheSameAnswers)
{
  const TestScene& scene = testScene("arm_boxes");
  const std::vector<std::uint8_t> exact = exactAnswers(scene);
  EXPECT_GT(std::count(exact.begin(), exact.end(), 0), static_cast<std::ptrdiff_t>(kStates / 20));
  for (const FclTree tree : {FclTree::Obbrss, FclTree::Obb, FclTree::Kios, FclTree::Aabb, FclTree::Kdop24})
    EXPECT_EQ(fclAnswers(scene, tree), exact) << static_cast<int>(tree);
}

TEST(FclTrees, OrderAndBroadPhaseChangeNoAnswer)
{
  for (const double padding : {0.0, 0.05})
  {
    const TestScene scene = padding > 0.0 ? withPadding(testScene("arm_shelf"), padding) : testScene("arm_shelf");
    EXPECT_EQ(fclAnswers(scene, FclTree::Obbrss, FclOrder::Learned), exactAnswers(scene)) << padding;
  }
}

TEST(FclTrees, PaddingIsADistance)
{
  const TestScene padded = withPadding(testScene("arm_boxes"), 0.05);
  const std::vector<std::uint8_t> exact = exactAnswers(padded);
  EXPECT_NE(exact, exactAnswers(testScene("arm_boxes")));
  EXPECT_EQ(fclAnswers(padded, FclTree::Obbrss), exact);
  EXPECT_EQ(fclAnswers(padded, FclTree::Kios), exact);
}

TEST(FittedBalls, CoverTheSurfaceAndFitCloserWhereThereAreMore)
{
  const auto mesh = closedSurface("egg", 2000, 2.0,
                                  [](double along, double angle) -> Eigen::Vector3d
                                  {
                                    const double away = 0.1 * std::sin(M_PI * along);
                                    return {away * std::cos(angle), away * std::sin(angle), 0.6 * along};
                                  });
  double last = 1e9;
  for (const std::size_t count : {1, 4, 16, 64})
  {
    const std::vector<benchmark::Ball> balls = benchmark::fitBalls(*mesh, count);
    EXPECT_LE(balls.size(), count);
    EXPECT_LT(uncovered(*mesh, balls), 0.01) << count;  // metres: gaps between the samples
    double highest = 0.0;
    for (const benchmark::Ball& ball : balls)
      highest = std::max(highest, static_cast<double>(ball.center.head<2>().norm() + ball.radius));
    EXPECT_LT(highest, last) << count;
    last = highest;
  }
  EXPECT_LT(last, 0.12);
}

TEST(GeneratedArm, HasAsManyTrianglesAsRequested)
{
  for (const std::size_t triangles : {1000, 50000})
  {
    const auto robot = GeneratedArm(triangles).load();
    EXPECT_NEAR(static_cast<double>(robot->triangleCount()), static_cast<double>(triangles),
                0.1 * static_cast<double>(triangles));
    EXPECT_EQ(robot->variables().size(), 6U);
  }
}
}  // namespace gpu_planning_scene::core
