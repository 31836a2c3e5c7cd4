#pragma once

#include <limits>
#include <string>
#include <vector>

#include <ros/publisher.h>
#include <ros/time.h>

#include "gpu_planning_scene/planning/trajectory_watch.h"
#include "node/messages/messages.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// A trajectory that the node watches.
struct Watched
{
  std::string id;
  WatchedTrajectory trajectory;  ///< its times are seconds from `start`
  ros::Time start;               ///< 0: the first verdict, which is not there yet
  bool follows = false;          ///< the robot's place comes from measured values, not from the clock
  double max_deviation = 0.0;    ///< radians or metres; 0: no limit
  ros::Publisher cancel;         ///< of actionlib_msgs/GoalID; invalid: nothing is cancelled
  ros::Time blocked_since;       ///< of the goals that are cancelled; 0: the verdict was FREE at the last check
  double time = 0.0;             ///< seconds: the robot's place on the trajectory
  /// Of the robot from its place; NaN: its values are not measured.
  double deviation = std::numeric_limits<double>::quiet_NaN();
  double age = 0.0;  ///< seconds: of the values from which the place comes; 0: it comes from the clock
  bool has_ended = false;
  ros::Time looked_at;                ///< when the place was found
  std::vector<double> stood_at = {};  ///< measured values of its variables from which the robot has hardly moved
  ros::Time stands_since;             ///< when it was there first
};

/// Reads a request. `now`: the ROS clock. The publisher is not set. `warnings` gets warnings about the trajectory.
/// Throws Error for a wrong request.
Watched watchedOf(const WatchTrajectory::Request& request, const Snapshot& scene, const ros::Time& now,
                  std::string& warnings);

/// Finds the robot's place. Throws Error if it needs measured values and there are none.
void findPlace(const Snapshot& scene, const ros::Time& now, Watched& watched);
}  // namespace gpu_planning_scene::core
