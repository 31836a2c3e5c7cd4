// The place of a robot on a watched trajectory, and its end. No ROS master is needed.

#include <cmath>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "node/watch/watched.h"

namespace gpu_planning_scene::core
{
namespace
{
const ros::Time kNow(1000.0);

/// A cart that goes 4 m along x in 4 s and then back.
class WatchedCart : public testing::Test
{
 protected:
  WatchedCart()
  {
    request_.id = "cart";
    request_.joint_trajectory.header.stamp = kNow;
    request_.joint_trajectory.joint_names = {"move"};
    for (const auto& [seconds, place] : {std::pair(0.0, 0.0), std::pair(4.0, 4.0), std::pair(8.0, 0.0)})
    {
      trajectory_msgs::JointTrajectoryPoint& point = request_.joint_trajectory.points.emplace_back();
      point.time_from_start = ros::Duration(seconds);
      point.positions = {place};
    }
    request_.max_deviation = 0.1;
    request_.follow_joint_states = true;
  }

  /// The robot at a place that was measured `age` seconds ago.
  Snapshot at(double place, double age = 0.0) const { return {scene_, {place}, {true}, {age}, {}, {}, 0, {0}}; }

  /// Whether the trajectory has ended for a robot that is at this place so many seconds after the start.
  bool hasEnded(double place, double seconds, Watched& cart) const
  {
    findPlace(at(place), kNow + ros::Duration(seconds), cart);
    return cart.has_ended;
  }

  Watched watched() { return watchedOf(request_, at(0.0), kNow, warnings_); }

  WatchTrajectory::Request request_;
  std::string warnings_;
  std::shared_ptr<const PlanningScene> scene_ = std::make_shared<const PlanningScene>(
      PlanningScene(robotOf("<link name=\"base\"/>" + boxLink("tip") +
                            jointXml("move", "prismatic", "base", "tip",
                                     "<limit lower=\"-200\" upper=\"200\" effort=\"1\" velocity=\"1\"/>"))));
};

TEST_F(WatchedCart, KeepsItsPlaceIfTheClockIsCorrectedAndLosesItIfASimulationBeginsAgain)
{
  Watched cart = watched();
  findPlace(at(0.05), kNow + ros::Duration(1.0), cart);
  for (const double seconds : {2.0, 4.0, 5.0})
    findPlace(at(seconds <= 4.0 ? seconds : 3.0), kNow + ros::Duration(seconds), cart);
  EXPECT_NEAR(cart.time, 5.0, 1e-9);
  findPlace(at(3.0), kNow + ros::Duration(4.9), cart);
  EXPECT_NEAR(cart.time, 5.0, 1e-9) << "it is on its way back";
  findPlace(at(3.0), kNow + ros::Duration(0.0), cart);
  EXPECT_NEAR(cart.time, 3.0, 1e-9) << "it is on its way there";
}

TEST_F(WatchedCart, HasArrivedIfItStandsWithinItsDeviationFromTheEnd)
{
  Watched cart = watched();
  hasEnded(4.0, 4.0, cart);
  EXPECT_FALSE(hasEnded(0.05, 7.95, cart));
  EXPECT_FALSE(hasEnded(0.05, 8.1, cart)) << "it may go on";
  EXPECT_FALSE(hasEnded(0.03, 8.9, cart));
  EXPECT_FALSE(hasEnded(0.03, 9.8, cart));
  EXPECT_TRUE(hasEnded(0.03, 10.0, cart));
  EXPECT_TRUE(hasEnded(0.005, 10.1, cart));
}

TEST_F(WatchedCart, HasArrivedAlsoBetweenCloseRowsBeforeTheEnd)
{
  request_.joint_trajectory.points.resize(2);
  for (const double rest : {0.02, 0.005, 0.0})
  {
    trajectory_msgs::JointTrajectoryPoint& point = request_.joint_trajectory.points.emplace_back();
    point.time_from_start = ros::Duration(5.0 - rest);
    point.positions = {5.0 - rest};
  }
  Watched cart = watched();
  hasEnded(4.5, 4.5, cart);
  EXPECT_FALSE(hasEnded(4.97, 5.1, cart));
  EXPECT_TRUE(hasEnded(4.97, 6.2, cart));
  cart = watched();
  hasEnded(4.5, 4.5, cart);
  EXPECT_TRUE(hasEnded(4.992, 5.1, cart)) << "within 0.01 of the last row";
}

TEST_F(WatchedCart, HasNotArrivedWhereItMayStillBeAtItsStart)
{
  request_.joint_trajectory.points.resize(2);
  request_.joint_trajectory.points[1].positions = {0.08};
  Watched cart = watched();
  for (const double seconds : {4.1, 6.0, 60.0})
    EXPECT_FALSE(hasEnded(0.0, seconds, cart)) << seconds;
  EXPECT_FALSE(hasEnded(0.06, 61.0, cart));
  EXPECT_TRUE(hasEnded(0.06, 62.5, cart)) << "it has left its start";
  EXPECT_TRUE(hasEnded(0.075, 63.0, cart));
}

TEST_F(WatchedCart, BeginsAtTheCurrentStateOnlyIfThisIsMeasuredNow)
{
  request_.joint_trajectory.points.erase(request_.joint_trajectory.points.begin());
  EXPECT_NO_THROW(watched());
  try
  {
    watchedOf(request_, at(0.0, 60.0), kNow, warnings_);
    ADD_FAILURE() << "the robot may be anywhere";
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(
        "the first point is at 4.000000 s, and joint_states has brought no value of 'move' for 60 s, so this joint may "
        "be "
        "anywhere; give a first point at 0 s",
        error.what());
  }
  EXPECT_NO_THROW(watchedOf(request_, at(0.0, INFINITY), kNow, warnings_)) << "a client has set it";
}
}  // namespace
}  // namespace gpu_planning_scene::core
