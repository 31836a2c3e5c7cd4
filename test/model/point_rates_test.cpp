// The rate of a point of a link by each variable is the slope of its position, for joints of all types.

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "model/all_joints_robot.h"
#include "model/point_rates.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(PointRates, AreTheSlopesOfTheLinkPoses)
{
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  constexpr double kStep = 1e-5;
  const auto robot = allJointsRobot();
  const std::size_t width = robot->variables().size();
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Eigen::Isometry3d> poses(robot->links().size());
  std::vector<double> state(width);
  for (int repetition = 0; repetition < 20; ++repetition)
  {
    robot->randomState(random, state.data());
    // A quaternion is normalised when it is read, so it may have any length.
    for (std::size_t v = 0; v < width; ++v)
      if (robot->variables()[v].name.find("/rot_") != std::string::npos)
        state[v] *= 3.0;
    const Eigen::Vector3d in_link(uniform(random), uniform(random), uniform(random));
    const Eigen::Vector3d direction = Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
    for (std::size_t link = 0; link < poses.size(); ++link)
    {
      const auto coordinate = [&]
      {
        robot->linkPoses(state.data(), poses.data());
        return direction.dot(poses[link] * in_link);
      };
      coordinate();
      std::vector<double> rates(width, 1.0);
      addPointRates(*robot, state.data(), poses.data(), static_cast<int>(link), poses[link] * in_link, direction, 2.0,
                    rates.data());
      for (std::size_t v = 0; v < width; ++v)
      {
        const double value = state[v];
        state[v] = value + kStep;
        const double above = coordinate();
        state[v] = value - kStep;
        const double below = coordinate();
        state[v] = value;
        EXPECT_NEAR(1.0 + 2.0 * (above - below) / (2.0 * kStep), rates[v], 1e-7)
            << robot->links()[link].name << " " << robot->variables()[v].name;
      }
    }
  }
}

TEST(PointRates, OfAQuaternionWithoutLengthAreZero)
{
  const auto robot = allJointsRobot();
  const std::vector<double> state(robot->variables().size(), 0.0);
  std::vector<Eigen::Isometry3d> poses(robot->links().size());
  robot->linkPoses(state.data(), poses.data());
  std::vector<double> rates(state.size(), 0.0);
  addPointRates(*robot, state.data(), poses.data(), static_cast<int>(poses.size()) - 1, {1.0, 2.0, 3.0},
                Eigen::Vector3d::UnitX(), 1.0, rates.data());
  for (std::size_t v = 0; v < state.size(); ++v)
    if (robot->variables()[v].name.find("/rot_") != std::string::npos)
      EXPECT_EQ(0.0, rates[v]) << robot->variables()[v].name;
}
}  // namespace
}  // namespace gpu_planning_scene::core
