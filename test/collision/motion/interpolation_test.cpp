// Straight motions between states: their interpolation, the joint travel, and the number of segments.

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A floating base with a planar platform, then one joint of each other kind, and a mimic joint.
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
  const std::vector<JointTravel> travel = jointTravel(*rack, from, to);
  const auto way = [&](const char* name) { return travel[static_cast<std::size_t>(rack->jointIndex(name))]; };
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
  const std::vector<JointTravel> travel = jointTravel(*geared, from, to);
  EXPECT_NEAR(travel[0].angle, 6.0, 1e-12);
  EXPECT_NEAR(travel[1].angle, 3.0, 1e-12);
}

TEST_F(Motions, AnglesTurnInTheShorterDirectionAndLimitedOnesWithinTheirLimits)
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

TEST_F(Motions, QuaternionsTurnEvenlyInTheShorterDirectionWhateverTheirSignAndLength)
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
    const double n = segmentCount(*robot_, from.data(), to.data(), steps);
    double largest = 0.0;  // largest step, relative to the allowed step
    for (double i = 0.0; i < n; ++i)
    {
      const std::vector<double> before = between(from, to, i / n);
      const std::vector<double> after = between(from, to, (i + 1.0) / n);
      const double* a = before.data();
      const double* b = after.data();
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
    EXPECT_GT(largest * n, n - 1.0 - 1e-6) << "cut finer than needed";
  }
}

TEST_F(Motions, WithoutAMoveAreOneSegment)
{
  EXPECT_EQ(1.0, segmentCount(*robot_, start_.data(), start_.data(), {0.1, 0.1}));
}

TEST_F(Motions, NeedStepsThatAreFiniteAndAboveZero)
{
  for (const double step : {0.0, -1.0, std::nan(""), HUGE_VAL})
  {
    EXPECT_NE(errorOf([&] { validateSteps({step, 0.1}); }).find("revolute step"), std::string::npos);
    EXPECT_NE(errorOf([&] { validateSteps({0.1, step}); }).find("prismatic step"), std::string::npos);
  }
  EXPECT_EQ("", errorOf([] { validateSteps({0.1, 1e-300}); }));
}

TEST_F(Motions, MayHaveMoreSegmentsThanAnIntegerHolds)
{
  std::vector<double> end = start_;
  end[at("push")] += 0.5;
  EXPECT_GT(segmentCount(*robot_, start_.data(), end.data(), {0.1, 1e-300}), 1e200);
}
}  // namespace
}  // namespace gpu_planning_scene::core
