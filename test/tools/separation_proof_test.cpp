// Proofs that two links never collide, against random states and against robots whose gap follows from arithmetic.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/forest_cache.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "tools/separation_proof.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kTests = 20000;

std::string limits(double lower, double upper)
{
  return "<limit lower='" + std::to_string(lower) + "' upper='" + std::to_string(upper) + "' effort='1' velocity='1'/>";
}

std::string origin(double x, double y, double z)
{
  return "<origin xyz='" + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "'/>";
}

std::string box(const std::string& link, const Eigen::Vector3d& center, const Eigen::Vector3d& size)
{
  return "<link name='" + link + "'><collision>" + origin(center.x(), center.y(), center.z()) +
         "<geometry><box size='" + std::to_string(size.x()) + " " + std::to_string(size.y()) + " " +
         std::to_string(size.z()) + "'/></geometry></collision></link>";
}

/// The proofs of a robot whose pairs of links are all checked.
class Proofs
{
 public:
  explicit Proofs(std::shared_ptr<const RobotModel> the_robot) : robot(std::move(the_robot))
  {
    PlanningScene scene(robot);
    scene.allowed_collisions = AllowedCollisionMatrix();
    problem = std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr));
    exact = trees.exactCheckerOf(problem);
  }

  Separation prove(const std::string& first, const std::string& second, std::size_t tests = kTests)
  {
    SeparationProver prover(robot, *problem, trees.forest());
    for (const InstancePair& pair : problem->self_pairs)
      if (bodiesOf(*problem, pair) == BodyPair{robot->linkIndex(first), robot->linkIndex(second)})
        return prover.prove(pair, tests);
    throw Error("no such pair");
  }

  std::shared_ptr<const RobotModel> robot;
  std::shared_ptr<const CollisionProblem> problem;
  ForestCache trees;
  std::unique_ptr<const ExactChecker> exact;
};

/// An arm of two links of half a metre that turns in a plane, and a post. When the arm is stretched towards the post,
/// its corner is `gap` away from the post, or in it where `gap` is negative.
std::shared_ptr<const RobotModel> armAndPost(double gap, const std::string& elbow_type = "revolute")
{
  const double corner = std::hypot(1.0, 0.01);  // half of the width is 0.01
  return robotOf(box("post", {corner + gap + 0.1, 0.0, 0.0}, {0.2, 0.2, 0.2}) +
                 box("upper", {0.25, 0.0, 0.0}, {0.5, 0.02, 0.02}) + box("fore", {0.25, 0.0, 0.0}, {0.5, 0.02, 0.02}) +
                 jointXml("shoulder", "revolute", "post", "upper", "<axis xyz='0 0 1'/>" + limits(-2.9, 3.0)) +
                 jointXml("elbow", elbow_type, "upper", "fore",
                          origin(0.5, 0.0, 0.0) + "<axis xyz='0 0 1'/>" + limits(-2.5, 2.4)));
}

TEST(SeparationProof, AGapOfTwoMillimetresIsProvenAndACollisionInFewStatesIsNot)
{
  EXPECT_EQ(Separation::Apart, Proofs(armAndPost(2e-3)).prove("post", "fore"));
  EXPECT_EQ(Separation::Apart, Proofs(armAndPost(2e-3, "continuous")).prove("post", "fore"));
  // The arm enters the post in about one of 100,000 states.
  EXPECT_NE(Separation::Apart, Proofs(armAndPost(-2e-4)).prove("post", "fore"));
  EXPECT_NE(Separation::Apart, Proofs(armAndPost(-2e-4, "continuous")).prove("post", "fore"));
  EXPECT_EQ(Separation::Meet, Proofs(armAndPost(-0.3)).prove("post", "fore"));
}

TEST(SeparationProof, NeedsTestsAndJointsWithRanges)
{
  EXPECT_EQ(Separation::Unknown, Proofs(armAndPost(2e-3)).prove("post", "fore", 0));
  for (const char* type : {"planar", "floating"})
    EXPECT_EQ(Separation::Unknown, Proofs(armAndPost(0.5, type)).prove("post", "fore")) << type;
}

TEST(SeparationProof, AJointAtItsLimitMayBeALittleBeyond)
{
  // The slider ends half a millimetre before the stop.
  const auto slider = [](double gap)
  {
    return robotOf(box("stop", {-0.5, 0.0, 0.0}, {1.0, 1.0, 1.0}) + box("cart", {0.5, 0.0, 0.0}, {1.0, 1.0, 1.0}) +
                   jointXml("slide", "prismatic", "stop", "cart",
                            origin(gap, 0.0, 0.0) + "<axis xyz='1 0 0'/>" + limits(0.0, 2.0)));
  };
  EXPECT_EQ(Separation::Apart, Proofs(slider(2e-3)).prove("stop", "cart"));
  EXPECT_NE(Separation::Apart, Proofs(slider(5e-4)).prove("stop", "cart"));
}

TEST(SeparationProof, TwoBodiesOneInsideTheOtherAreNotApart)
{
  const auto in_shell =
      robotOf(box("shell", {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}) + box("core", {0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}) +
              jointXml("turn", "continuous", "shell", "core", "<axis xyz='0 0 1'/>"));
  EXPECT_EQ(Separation::Meet, Proofs(in_shell).prove("shell", "core"));
}

class SeparationProofOfRandomRobots : public testing::TestWithParam<unsigned>
{
};

/// A base with two branches. The joints are of all kinds with one variable; the last joint of the second branch mimics
/// the first joint of the first branch.
std::shared_ptr<const RobotModel> randomRobot(std::mt19937& generator)
{
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&](double scale) -> Eigen::Vector3d
  { return scale * Eigen::Vector3d(unit(generator), unit(generator), unit(generator)); };
  const auto random_box = [&](const std::string& name)
  { return box(name, vector(0.2), Eigen::Vector3d::Constant(0.05) + vector(0.2).cwiseAbs()); };
  std::string urdf = random_box("base");
  for (const std::string branch : {"l", "r"})
  {
    std::string parent = "base";
    for (int i = 0; i < 2; ++i)
    {
      const std::string name = branch + std::to_string(i);
      // A follower of a continuous joint would turn without limits.
      const int kind = static_cast<int>(generator() % (name == "l0" ? 2U : 3U));
      const Eigen::Vector3d axis = vector(1.0).normalized();
      const Eigen::Vector3d at = vector(0.6);
      const double range = kind == 0 ? 0.3 : 1.5;
      urdf += random_box(name) +
              jointXml("joint_" + name,
                       kind == 0   ? "prismatic"
                       : kind == 1 ? "revolute"
                                   : "continuous",
                       parent, name,
                       origin(at.x(), at.y(), at.z()) + "<axis xyz='" + std::to_string(axis.x()) + " " +
                           std::to_string(axis.y()) + " " + std::to_string(axis.z()) + "'/>" +
                           limits(range * (unit(generator) - 1.0), range * (unit(generator) + 1.0)) +
                           (name == "r1" ? "<mimic joint='joint_l0' multiplier='-0.7' offset='0.2'/>" : ""));
      parent = name;
    }
  }
  return robotOf(urdf);
}

TEST_P(SeparationProofOfRandomRobots, NoRandomStateCollidesWhereAPairIsProvenApart)
{
  std::mt19937 generator(GetParam());
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  std::size_t apart = 0;
  std::size_t meet = 0;
  for (int i = 0; i < 4; ++i)
  {
    Proofs proofs(randomRobot(generator));
    std::vector<std::size_t> hits(proofs.problem->self_pairs.size(), 0);
    std::mt19937_64 states(GetParam());
    std::vector<double> state(proofs.robot->variables().size());
    std::vector<Eigen::Isometry3d> poses(proofs.robot->links().size());
    ExactChecker::Scratch scratch;
    for (int k = 0; k < 3000; ++k)
    {
      proofs.robot->randomState(states, state.data());
      proofs.robot->linkPoses(state.data(), poses.data());
      const std::vector<InstancePair> colliding = proofs.exact->collidingInstances(poses.data(), scratch);
      for (std::size_t p = 0; p < hits.size(); ++p)
        hits[p] += std::count(colliding.begin(), colliding.end(), proofs.problem->self_pairs[p]) != 0 ? 1 : 0;
    }
    SeparationProver prover(proofs.robot, *proofs.problem, proofs.trees.forest());
    for (std::size_t p = 0; p < hits.size(); ++p)
    {
      const Separation result = prover.prove(proofs.problem->self_pairs[p], 4000);
      if (result == Separation::Apart)
        EXPECT_EQ(0u, hits[p]) << "robot " << i << ", pair " << p;
      if (hits[p] > 30)
        EXPECT_EQ(Separation::Meet, result) << "robot " << i << ", pair " << p << ", " << hits[p] << " of 3000 states";
      apart += result == Separation::Apart ? 1 : 0;
      meet += result == Separation::Meet ? 1 : 0;
    }
  }
  EXPECT_GT(apart, 0u);
  EXPECT_GT(meet, 0u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SeparationProofOfRandomRobots, testing::Range(1u, 5u));
}  // namespace
}  // namespace gpu_planning_scene::core
