#pragma once

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
  ros::Time start;
  bool follows = false;        ///< progress comes from measured values, not from the clock
  double max_deviation = 0.0;  ///< radians or metres; 0: no limit
  ros::Publisher cancel;       ///< of actionlib_msgs/GoalID; invalid: nothing is cancelled
  Progress progress = {};      ///< where the robot is; `deviation` is NaN if the values are not measured
  ros::Time looked_at;         ///< when `progress` was found
};

/// Reads a request. `now`: the ROS clock. The publisher is not set. Throws Error for a wrong request.
Watched watchedOf(const WatchTrajectory::Request& request, const Snapshot& scene, const ros::Time& now);

/// Finds where the robot is. Throws Error if the trajectory follows measured values and there are none.
void findProgress(const Snapshot& scene, const ros::Time& now, Watched& watched);

/// Whether the robot has reached the end of the trajectory.
bool hasEnded(const Watched& watched);
}  // namespace gpu_planning_scene::core
