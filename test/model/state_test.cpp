#include <cmath>

#include <gtest/gtest.h>

#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string limits(const std::string& lower, const std::string& upper)
{
  return "<limit lower=\"" + lower + "\" upper=\"" + upper + "\" effort=\"1\" velocity=\"1\"/>";
}

std::string slider(const std::string& lower, const std::string& upper)
{
  return boxLink("a") + boxLink("b") + jointXml("j", "prismatic", "a", "b", limits(lower, upper));
}

TEST(State, RandomStatesFillTheirLimitsAndStayInside)
{
  constexpr std::uint64_t kSeed = 3;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  const auto robot = robotOf(armUrdf());
  const std::size_t size = robot->variables().size();
  std::vector<double> lowest(size, 10.0), highest(size, -10.0), state(size);
  for (int i = 0; i < 2000; ++i)
  {
    robot->randomState(generator, state.data());
    for (std::size_t v = 0; v < size; ++v)
    {
      ASSERT_GE(state[v], robot->variables()[v].lower);
      ASSERT_LE(state[v], robot->variables()[v].upper);
      lowest[v] = std::min(lowest[v], state[v]);
      highest[v] = std::max(highest[v], state[v]);
    }
  }
  for (std::size_t v = 0; v < size; ++v)
  {
    const double range = robot->variables()[v].upper - robot->variables()[v].lower;
    EXPECT_LT(lowest[v], robot->variables()[v].lower + 0.01 * range);
    EXPECT_GT(highest[v], robot->variables()[v].upper - 0.01 * range);
  }
}

TEST(State, RandomStatesCanKeepPlanarAndFloatingJoints)
{
  for (const std::string type : {"planar", "floating"})
  {
    SCOPED_TRACE(type);
    const auto robot = robotOf(boxLink("ground") + boxLink("a") + boxLink("b") + jointXml("base", type, "ground", "a") +
                               jointXml("j", "prismatic", "a", "b", limits("0", "1")));
    std::vector<double> base = robot->defaultState();
    base[0] = 7.0;
    std::vector<double> state(base.size());
    std::mt19937_64 generator(5);
    robot->randomState(generator, base.data(), state.data());
    const auto slide = static_cast<std::size_t>(robot->variableIndex("j"));
    EXPECT_NE(base[slide], state[slide]);
    base[slide] = state[slide];
    EXPECT_EQ(base, state);
    robot->randomState(generator, state.data());
    EXPECT_NE(7.0, state[0]);
  }
}

TEST(State, RandomStatesAreTheSameWithEveryStandardLibrary)
{
  std::mt19937_64 generator;  // the C++ standard specifies its 10,000th number
  generator.discard(9999);
  double state;
  robotOf(slider("0", "1"))->randomState(generator, &state);
  EXPECT_EQ(state, static_cast<double>(9981545732273789042u >> 11) / 9007199254740992.0);
}

TEST(State, TheWidestLimitsDoNotOverflow)
{
  std::mt19937_64 generator(1);
  const auto robot = robotOf(slider("-1.7e308", "1.7e308"));
  double least = 0.0;
  double largest = 0.0;
  for (int i = 0; i < 100; ++i)
  {
    double state;
    robot->randomState(generator, &state);
    ASSERT_TRUE(std::isfinite(state));
    least = std::min(least, state);
    largest = std::max(largest, state);
  }
  EXPECT_LT(least, -1e308);
  EXPECT_GT(largest, 1e308);
  EXPECT_LT(largest, 1.7e308) << "an overflow cut to the limit";
  EXPECT_EQ(robot->defaultState()[0], 0.0);
}

TEST(State, RandomRotationsAreUniform)
{
  constexpr std::uint64_t kSeed = 5;
  constexpr int kStates = 40000;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  const auto robot = robotOf(boxLink("a") + boxLink("b") + jointXml("j", "floating", "a", "b"));
  std::vector<double> state(7);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  Eigen::Vector4d fourth_powers = Eigen::Vector4d::Zero();
  Eigen::Matrix4d products = Eigen::Matrix4d::Zero();
  for (int i = 0; i < kStates; ++i)
  {
    robot->randomState(generator, state.data());
    const Eigen::Map<const Eigen::Vector4d> q(state.data() + 3);
    ASSERT_NEAR(q.norm(), 1.0, 1e-15);
    sum += q;
    products += q * q.transpose();
    fourth_powers += q.array().pow(4).matrix();
  }
  // On the sphere in four dimensions: mean 0, E[q q^T] = I / 4, E[q_i^4] = 1 / 8.
  EXPECT_LT((sum / kStates).norm(), 0.02);
  EXPECT_LT((products / kStates - 0.25 * Eigen::Matrix4d::Identity()).norm(), 0.02);
  EXPECT_LT((fourth_powers / kStates - Eigen::Vector4d::Constant(0.125)).norm(), 0.01);
}

TEST(State, TheDefaultIsZeroOrTheMiddleOfTheLimits)
{
  EXPECT_EQ(robotOf(slider("-1", "3"))->defaultState()[0], 0.0);
  EXPECT_EQ(robotOf(slider("0", "3"))->defaultState()[0], 0.0);
  EXPECT_EQ(robotOf(slider("1", "3"))->defaultState()[0], 2.0);
  EXPECT_EQ(robotOf(slider("-3", "-1"))->defaultState()[0], -2.0);
}

TEST(State, TheDefaultOfAFloatingJointIsTheUnitQuaternion)
{
  const auto robot = robotOf(boxLink("a") + boxLink("b") + jointXml("j", "floating", "a", "b"));
  EXPECT_EQ(robot->defaultState(), (std::vector<double>{0, 0, 0, 0, 0, 0, 1}));
}
}  // namespace
}  // namespace gpu_planning_scene::core
