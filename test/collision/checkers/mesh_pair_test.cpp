// Two rigid shapes in many poses. The answers are compared with distances that are known without a tree.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/mesh_pair_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
class MeshPair : public testing::TestWithParam<Traversal>
{
 protected:
  BatchCheckerOptions options() const
  {
    BatchCheckerOptions chosen;
    chosen.traversal = GetParam();
    return chosen;
  }
};

TEST_P(MeshPair, SpheresMeetWhereTheirCentresAreNearerThanTheirRadii)
{
  constexpr std::uint64_t kSeed = 5;
  constexpr std::size_t kPoses = 3000;
  const Tessellation large = tessellate(Sphere{0.2});
  const Tessellation small = tessellate(Sphere{0.1});
  // The spheres are meshes, so that surfaces are compared. No distance is so small that one contains the other.
  MeshPairChecker checker(large.mesh, small.mesh, options());
  std::mt19937_64 generator(kSeed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> distance(0.11, 0.4);
  std::vector<Eigen::Isometry3d> poses;
  std::vector<double> distances;
  for (std::size_t i = 0; i < kPoses; ++i)
  {
    const Eigen::Vector3d direction =
        Eigen::Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
    distances.push_back(distance(generator));
    Eigen::Isometry3d pose(Eigen::Translation3d(distances.back() * direction));
    pose.rotate(Eigen::AngleAxisd(normal(generator), direction.unitOrthogonal()));
    poses.push_back(pose);
  }
  const std::vector<std::uint8_t> hits = checker.collide(poses);
  const double sagitta = large.sagitta + small.sagitta;
  std::size_t met = 0;
  for (std::size_t i = 0; i < kPoses; ++i)
  {
    met += hits[i];
    if (distances[i] > 0.3)
      EXPECT_EQ(hits[i], 0) << "pose " << i << ", seed " << kSeed << ", distance " << distances[i];
    if (distances[i] < 0.3 - sagitta)
      EXPECT_EQ(hits[i], 1) << "pose " << i << ", seed " << kSeed << ", distance " << distances[i];
  }
  EXPECT_GT(met, kPoses / 4);
  EXPECT_LT(checker.undecided(), kPoses / 50);
}

TEST_P(MeshPair, BoxesTouchAtTheirFaces)
{
  MeshPairChecker checker(Box{{1, 1, 1}}, Box{{0.5, 0.5, 0.5}}, options());
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0.1, 0.2)); };
  EXPECT_EQ(checker.collide({at(0.75), at(0.75 - 1e-6), at(0.75 + 1e-6), at(0.7), at(0.8), at(5.0)}),
            (std::vector<std::uint8_t>{1, 1, 0, 1, 0, 0}));
}

TEST_P(MeshPair, CurvedSolidsAreDecidedByTheirTrueSurfaces)
{
  // Two cylinders with crossed axes. Their distance is the distance of the axes minus the radii.
  constexpr std::uint64_t kSeed = 7;
  MeshPairChecker checker(Cylinder{0.05, 0.4}, Cylinder{0.03, 0.3}, options());
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::vector<Eigen::Isometry3d> poses;
  std::vector<double> gaps;
  for (int i = 0; i < 300; ++i)
  {
    // Gaps of the size of the tessellations' sagittas, in both directions.
    gaps.push_back(share(generator) * 2e-4);
    Eigen::Isometry3d pose(Eigen::AngleAxisd(EIGEN_PI * share(generator), Eigen::Vector3d::UnitZ()));
    pose.translate(Eigen::Vector3d(0.08 + gaps.back(), 0.0, 0.1 * share(generator)));
    pose.rotate(Eigen::AngleAxisd(EIGEN_PI * (0.5 + 0.3 * share(generator)), Eigen::Vector3d::UnitX()));
    poses.push_back(pose);
  }
  const std::vector<std::uint8_t> hits = checker.collide(poses);
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (std::abs(gaps[i]) > 2e-6)
      EXPECT_EQ(hits[i], gaps[i] < 0.0 ? 1 : 0) << "pose " << i << ", seed " << kSeed << ", gap " << gaps[i];
  EXPECT_GT(checker.undecided(), 10U);
}

TEST_P(MeshPair, NoPosesGiveNoAnswers)
{
  MeshPairChecker checker(Box{{1, 1, 1}}, Sphere{0.5}, options());
  EXPECT_TRUE(checker.collide({}).empty());
}

TEST_P(MeshPair, PosesThatAreNotRigidMotionsAreRefused)
{
  MeshPairChecker checker(Box{{1, 1, 1}}, Sphere{0.5}, options());
  std::vector<Eigen::Isometry3d> poses(3, Eigen::Isometry3d::Identity());
  poses[1].linear() *= 2.0;
  EXPECT_THROW(checker.collide(poses), Error);
  poses[1].linear() = Eigen::Vector3d(1, 1, -1).asDiagonal();
  EXPECT_THROW(checker.collide(poses), Error);
  poses[1] = Eigen::Isometry3d::Identity();
  poses[1].translation().x() = std::nan("");
  EXPECT_THROW(checker.collide(poses), Error);
}

INSTANTIATE_TEST_SUITE_P(Traversals, MeshPair, testing::Values(Traversal::BreadthFirst, Traversal::WorkQueue),
                         [](const auto& parameter)
                         { return parameter.param == Traversal::WorkQueue ? "WorkQueue" : "BreadthFirst"; });
}  // namespace
}  // namespace gpu_planning_scene::core
