// Motions are cut finely enough, go the shorter way, and their verdicts are those of a search state by state.

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/motions.h"
#include "model/model_testing.h"

namespace gpu_planning_scene
{
namespace
{
/// A floating base, a planar platform on it, then one joint of each other kind, and a mimic one.
std::shared_ptr<const RobotModel> movingRobot()
{
  return robotOf(boxLink("base") + boxLink("platform") + boxLink("wheel") + boxLink("arm") + boxLink("slide") +
                     boxLink("follower") + jointXml("drive", "planar", "base", "platform") +
                     jointXml("spin", "continuous", "platform", "wheel") +
                     jointXml("bend", "revolute", "wheel", "arm", kLimits) +
                     jointXml("push", "prismatic", "arm", "slide", kLimits) +
                     jointXml("follow", "revolute", "slide", "follower",
                              std::string(kLimits) + "<mimic joint=\"bend\" multiplier=\"2\"/>"),
                 "<virtual_joint name=\"free\" type=\"floating\" parent_frame=\"world\" "
                 "child_link=\"base\"/>");
}

class Motions : public testing::Test
{
 protected:
  std::size_t at(const char* variable) const
  {
    const int index = robot_->variableIndex(variable);
    if (index < 0)
      throw std::out_of_range(variable);
    return static_cast<std::size_t>(index);
  }

  std::vector<double> between(const std::vector<double>& from, const std::vector<double>& to, double fraction) const
  {
    std::vector<double> state(from.size(), std::nan(""));
    interpolate(*robot_, from.data(), to.data(), fraction, state.data());
    return state;
  }

  MotionBatch batch(const std::vector<double>& from, const std::vector<double>& to, const MotionSteps& steps,
                    std::size_t most = 100000) const
  {
    return MotionBatch(*robot_, from.data(), to.data(), from.size() / width_, steps, most);
  }

  static Eigen::Quaterniond rotation(const double* base)
  {
    return Eigen::Quaterniond(base[6], base[3], base[4], base[5]);
  }

  std::shared_ptr<const RobotModel> robot_ = movingRobot();
  std::size_t width_ = robot_->variables().size();
  std::vector<double> start_ = robot_->defaultState();
};

TEST_F(Motions, JointsMoveAsFarAsTheirLeadersMakeThem)
{
  const auto rack =
      robotOf(boxLink("base") + boxLink("rack") + boxLink("wheel") + boxLink("pin") +
              jointXml("slide", "prismatic", "base", "rack", kLimits) +
              jointXml("spin", "continuous", "base", "wheel", "<mimic joint=\"slide\" multiplier=\"-10\"/>") +
              jointXml("bolt", "fixed", "base", "pin"));
  const double from[] = {-0.5};
  const double to[] = {1.5};
  const std::vector<JointWay> ways = jointWays(*rack, from, to);
  const auto way = [&](const char* name) { return ways[static_cast<std::size_t>(rack->jointIndex(name))]; };
  EXPECT_NEAR(way("slide").length, 2.0, 1e-12);
  EXPECT_EQ(way("slide").angle, 0.0);
  EXPECT_NEAR(way("spin").angle, 20.0, 1e-12);
  EXPECT_EQ(way("spin").length, 0.0);
  EXPECT_EQ(way("bolt").angle, 0.0);
}

TEST_F(Motions, AContinuousJointWithAnUnevenFollowerDoesNotWrap)
{
  const auto geared =
      robotOf(boxLink("base") + boxLink("wheel") + boxLink("hand") + jointXml("spin", "continuous", "base", "wheel") +
              jointXml("turn", "continuous", "base", "hand", "<mimic joint=\"spin\" multiplier=\"0.5\"/>"));
  const double from[] = {3.0};
  const double to[] = {-3.0};
  double state[] = {0.0};
  interpolate(*geared, from, to, 0.5, state);
  EXPECT_NEAR(state[0], 0.0, 1e-12);
  const std::vector<JointWay> ways = jointWays(*geared, from, to);
  EXPECT_NEAR(ways[0].angle, 6.0, 1e-12);
  EXPECT_NEAR(ways[1].angle, 3.0, 1e-12);
}

TEST_F(Motions, AnglesGoTheShorterWayAndLimitedOnesTheWayWithinTheirLimits)
{
  std::vector<double> end = start_;
  for (const char* name : {"spin", "drive/theta"})
  {
    start_[at(name)] = 3.0;
    end[at(name)] = -3.0;
    EXPECT_NEAR(between(start_, end, 0.5)[at(name)], M_PI, 1e-12) << name;
    end[at(name)] = 3.0 + 4.0 * M_PI + 0.2;
    EXPECT_NEAR(between(start_, end, 0.5)[at(name)], 3.1, 1e-12) << name;
  }
  start_[at("bend")] = 2.0;
  end[at("bend")] = -2.0;
  EXPECT_NEAR(between(start_, end, 0.5)[at("bend")], 0.0, 1e-12);
  EXPECT_NEAR(between(start_, end, 0.75)[at("bend")], -1.0, 1e-12);
}

TEST_F(Motions, QuaternionsTurnEvenlyTheShorterWayWhateverTheirSignAndLength)
{
  const std::size_t first = at("free/rot_x");
  std::vector<double> end = start_;
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  for (const double scale : {1.0, -1.0, 3.0, 1e-200})
  {
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(2.0, axis));
    Eigen::Map<Eigen::Vector4d>(end.data() + first) = scale * turned.coeffs();
    const std::vector<double> state = between(start_, end, 0.25);
    EXPECT_LT(rotation(&state[first - 3]).angularDistance(Eigen::Quaterniond(Eigen::AngleAxisd(0.5, axis))), 1e-7);
  }
}

TEST_F(Motions, TheirEndsAreTheGivenStatesBitByBit)
{
  std::mt19937_64 generator(3);
  std::vector<double> end(width_);
  robot_->randomState(generator, end.data());
  end[at("spin")] += 20.0;
  EXPECT_EQ(between(start_, end, 0.0), start_);
  EXPECT_EQ(between(start_, end, 1.0), end);
}

TEST_F(Motions, AreCutSoThatNothingMovesMoreThanItsStepAndNoFiner)
{
  const unsigned seed = 11;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  const MotionSteps steps{0.07, 0.03};
  for (int k = 0; k < 50; ++k)
  {
    std::vector<double> from(width_), to(width_);
    robot_->randomState(generator, from.data());
    robot_->randomState(generator, to.data());
    const MotionBatch motion = batch(from, to, steps);
    double largest = 0.0;  // of all steps, in units of what is allowed
    for (std::size_t i = 0; i + 1 < motion.stateCount(); ++i)
    {
      const double* a = &motion.states()[i * width_];
      const double* b = a + width_;
      for (const char* name : {"free/trans_x", "free/trans_y", "free/trans_z", "drive/x", "drive/y", "push"})
        largest = std::max(largest, std::abs(b[at(name)] - a[at(name)]) / steps.prismatic);
      largest = std::max(largest, std::abs(b[at("bend")] - a[at("bend")]) / steps.revolute);
      for (const char* name : {"spin", "drive/theta"})
        largest = std::max(largest, std::abs(std::remainder(b[at(name)] - a[at(name)], 2.0 * M_PI)) / steps.revolute);
      largest =
          std::max(largest, 0.5 * rotation(a + at("free/trans_x")).angularDistance(rotation(b + at("free/trans_x"))) /
                                steps.revolute);
    }
    EXPECT_LE(largest, 1.0 + 1e-6);
    const double n = static_cast<double>(motion.stateCount() - 1);
    EXPECT_GT(largest * n, n - 1.0 - 1e-6) << "cut finer than needed";
  }
}

TEST_F(Motions, WithoutAMoveAreTheirTwoEnds)
{
  const MotionBatch motion = batch(start_, start_, {0.1, 0.1});
  EXPECT_EQ(motion.stateCount(), 2u);
  EXPECT_TRUE(motion.verdicts({{1, 1}, {}}).at(0).valid);
}

TEST_F(Motions, AreJudgedByTheirFirstHit)
{
  std::vector<double> to = start_;
  to[at("push")] = start_[at("push")] + 0.4;
  std::vector<double> starts = start_, ends = to;  // two motions of five states
  starts.insert(starts.end(), start_.begin(), start_.end());
  ends.insert(ends.end(), to.begin(), to.end());
  const MotionBatch motions = batch(starts, ends, {0.1, 0.1000001});
  ASSERT_EQ(motions.stateCount(), 10u);
  for (unsigned hits = 0; hits < 32; ++hits)  // brute force over what the second may meet
  {
    BatchResult result;
    result.valid.assign(10, 1);
    for (unsigned i = 0; i < 5; ++i)
      result.valid[5 + i] = (hits >> i & 1u) != 0 ? 0 : 1;
    const auto verdicts = motions.verdicts(result);
    ASSERT_EQ(verdicts.size(), 2u);
    EXPECT_TRUE(verdicts[0].valid);
    EXPECT_EQ(verdicts[0].last_valid, 1.0);
    unsigned first = 0;
    while (first < 5 && (hits >> first & 1u) == 0)
      ++first;
    EXPECT_EQ(verdicts[1].valid, first == 5) << hits;
    EXPECT_EQ(verdicts[1].last_valid, first == 5 ? 1.0 : first == 0 ? 0.0 : (first - 1) / 4.0) << hits;
    EXPECT_EQ(verdicts[1].first_invalid, first == 5 ? 1.0 : first / 4.0) << hits;
    EXPECT_EQ(verdicts[1].invalid_state, first == 5 ? 10u : 5u + first) << hits;
  }
}

TEST_F(Motions, OfTooManyStatesOrWithoutStepsAreRefused)
{
  std::vector<double> end = start_;
  end[at("push")] += 0.5;
  EXPECT_EQ(batch(start_, end, {0.1, 0.5}, 2).stateCount(), 2u);
  EXPECT_EQ(errorOf(
                [&] {
                  batch(start_, end, {0.1, 0.1}, 5);
                }),
            "the motions are more than 5 states by motion 0; send fewer motions or take larger steps");
  for (const double step : {0.0, -1.0, std::nan(""), HUGE_VAL})
  {
    EXPECT_NE(errorOf([&] { batch(start_, end, {step, 0.1}); }).find("revolute step"), std::string::npos);
    EXPECT_NE(errorOf([&] { batch(start_, end, {0.1, step}); }).find("prismatic step"), std::string::npos);
  }
  EXPECT_THROW(batch(start_, end, {0.1, 1e-300}), Error);
  end[at("push")] = 1.7e308;
  start_[at("push")] = -1.7e308;
  EXPECT_THROW(batch(start_, end, {0.1, 1.0}), Error);
  end[at("push")] = std::nan("");
  EXPECT_THROW(batch(start_, end, {0.1, 0.1}), Error);
}
}  // namespace
}  // namespace gpu_planning_scene
