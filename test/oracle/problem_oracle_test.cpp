// Compares the oracle's kinematics with the project's, and tests its verdicts on whole states.

#include <gtest/gtest.h>

#include "model/model_testing.h"
#include "oracle/problem_oracle.h"

using namespace gpu_planning_scene::core;
using oracle::Motion;
using oracle::ProblemOracle;
using oracle::Verdict;

namespace
{
Eigen::Isometry3d shifted(double x, double y, double z)
{
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/// Two spheres of radius 0.5 on links 0 and 1, a box of the world around the origin, and the ground at z = -3.
std::shared_ptr<CollisionProblem> spheresAndBox()
{
  auto problem = std::make_shared<CollisionProblem>();
  problem->shapes = {Sphere{0.5}, Box{{1.0, 1.0, 1.0}}};
  problem->robot = {{0, 0, 0, shifted(0.0, 0.0, 1.0), 0.125}, {0, 1, 1, Eigen::Isometry3d::Identity(), 0.25}};
  problem->world = {{1, 2, -1, shifted(0.0, 0.0, 0.0), 0.125}};
  problem->half_spaces = {{3, Eigen::Vector3d::UnitZ(), -3.0, 0.0}};
  problem->world_pairs = {1, 0};
  problem->half_space_pairs = {0, 1};
  problem->self_pairs = {{0, 1}};
  return problem;
}

Verdict verdictOf(const std::shared_ptr<CollisionProblem>& problem, const Eigen::Isometry3d& first,
                  const Eigen::Isometry3d& second)
{
  return ProblemOracle(problem).verdict({Motion(first), Motion(second)});
}
}  // namespace

TEST(ProblemOracle, KinematicsAgreeWithThoseInDouble)
{
  const std::string urdf =
      boxLink("base") + boxLink("l1") + boxLink("l2") + boxLink("l3") + boxLink("l4") + boxLink("l5") + boxLink("l6") +
      jointXml("a", "revolute", "base", "l1",
               kLimits + std::string("<axis xyz='1 2 3'/>"
                                     "<origin xyz='1 0 2' rpy='1 2 3'/>")) +
      jointXml("b", "prismatic", "l1", "l2", kLimits + std::string("<axis xyz='0 1 1'/>")) +
      jointXml("c", "planar", "l2", "l3", "<axis xyz='1 1 0'/>") + jointXml("d", "floating", "l3", "l4") +
      jointXml("e", "continuous", "l4", "l5",
               "<axis xyz='0 0 1'/>"
               "<mimic joint='a' multiplier='2' offset='0.5'/>") +
      jointXml("f", "fixed", "l5", "l6", "<origin xyz='0 1 0' rpy='0.1 0.2 0.3'/>");
  const auto robot = robotOf(urdf);
  std::mt19937_64 random(5);
  std::vector<double> state(robot->variables().size());
  std::vector<Eigen::Isometry3d> expected(robot->links().size());
  for (int i = 0; i < 100; ++i)
  {
    robot->randomState(random, state.data());
    robot->linkPoses(state.data(), expected.data());
    const std::vector<Motion> poses = oracle::linkPoses(*robot, state.data());
    for (std::size_t link = 0; link < poses.size(); ++link)
      ASSERT_TRUE(poses[link].toDouble().isApprox(expected[link], 1e-14)) << robot->links()[link].name;
  }
}

TEST(ProblemOracle, ChecksThePairsThatTheProblemSays)
{
  const auto problem = spheresAndBox();
  EXPECT_EQ(verdictOf(problem, shifted(10, 0, 0), shifted(0, 0, 10)), Verdict::Free);
  EXPECT_EQ(verdictOf(problem, shifted(0, 0, -1), shifted(0, 0, 10)), Verdict::Collides);   // with the box
  EXPECT_EQ(verdictOf(problem, shifted(10, 0, 0), shifted(0, 0, 0)), Verdict::Free);        // this pair is not checked
  EXPECT_EQ(verdictOf(problem, shifted(10, 0, 0), shifted(20, 0, -3)), Verdict::Collides);  // with the ground
  EXPECT_EQ(verdictOf(problem, shifted(10, 0, -20), shifted(0, 0, 10)), Verdict::Free);  // not checked with the ground
  EXPECT_EQ(verdictOf(problem, shifted(10, 0, 0), shifted(10.5, 0, 1)), Verdict::Collides);  // with each other
}

TEST(ProblemOracle, PaddingIsAddedForTheWorldOnly)
{
  const auto problem = spheresAndBox();
  // The sphere's lowest point is 0.25 m above the box, which is the sum of the paddings.
  EXPECT_EQ(verdictOf(problem, shifted(0, 0, 0.25), shifted(0, 0, 10)), Verdict::Collides);
  EXPECT_EQ(verdictOf(problem, shifted(0, 0, 0.25 + 0.5e-9), shifted(0, 0, 10)), Verdict::Either);
  EXPECT_EQ(verdictOf(problem, shifted(0, 0, 0.25 + 2e-9), shifted(0, 0, 10)), Verdict::Free);
  EXPECT_EQ(verdictOf(problem, shifted(10, 0, 0), shifted(0, 0, -2.25)), Verdict::Collides);
  EXPECT_EQ(verdictOf(problem, shifted(10, 0, 0), shifted(0, 0, -2.25 + 2e-9)), Verdict::Free);
  EXPECT_EQ(verdictOf(problem, shifted(10, 0, 0), shifted(11.01, 0, 1)), Verdict::Free);
}

TEST(ProblemOracle, ClearanceIsTheLeastDistanceBeyondTheRequiredOne)
{
  const ProblemOracle oracle(spheresAndBox());
  const auto clearance = [&](const Eigen::Isometry3d& first, const Eigen::Isometry3d& second, double limit) {
    return oracle.clearance({Motion(first), Motion(second)}, limit);
  };
  EXPECT_NEAR(clearance(shifted(0, 0, 1), shifted(0, 0, 10), 100.0), 0.75, 1e-12);
  EXPECT_NEAR(clearance(shifted(0, 0, -0.9), shifted(0, 0, 10), 100.0), -0.25, 1e-12);
  EXPECT_GE(clearance(shifted(0, 0, 1), shifted(0, 0, 10), 0.5), 0.5);
  EXPECT_EQ(oracle.pairVerdict({Motion(shifted(10, 0, 0)), Motion(shifted(0, 0, 0))}, 1, 2), Verdict::Collides);
  EXPECT_EQ(oracle.pairVerdict({Motion(shifted(10, 0, 0)), Motion(shifted(0, 0, 0))}, 0, 1), Verdict::Free);
  EXPECT_EQ(oracle.pairVerdict({Motion(shifted(10, 0, -20)), Motion(shifted(0, 0, 0))}, 0, 3), Verdict::Collides);
}
