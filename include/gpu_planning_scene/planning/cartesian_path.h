#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// A request for a path along which a frame of a link moves on straight lines.
struct CartesianQuery
{
  std::string group;
  int link = -1;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();  ///< the moved frame, in the link's frame
  std::vector<double> start;  ///< one value per variable of the robot; variables outside the group keep these values
  /// Poses of the frame in the planning frame, after its pose in the start. Between two poses, the origin moves on a
  /// straight line, and the frame turns at a constant rate about a fixed axis.
  std::vector<Eigen::Isometry3d> waypoints;
  double max_step = 0.01;           ///< metres between rows of the path, above 0
  double max_rotation_step = 0.05;  ///< radians between rows of the path, above 0
  /// Largest deviations of the frame from the line between two rows, where the joints move on a straight motion. Steps
  /// are halved until they keep it. Above 1e-7.
  double max_deviation = 1e-4;           ///< metres
  double max_rotation_deviation = 1e-3;  ///< radians
  /// The jump bound: the largest displacement of a joint between two rows, radians or metres. Near a singularity, a
  /// small step of the frame needs a large one of the joints: such a step is halved. If it is still too large at a
  /// hundredth of the steps above, the path ends there.
  double max_joint_step = 0.2;
  /// The largest number of rows of the path. Lines with more steps are refused. If halved steps need more rows, the
  /// path ends early.
  std::size_t max_rows = 1000000;
  bool check_collisions = true;
  MotionCheckerOptions motions = {};
  KinematicConstraints path_constraints = {};  ///< hold along the whole path
};

struct CartesianPath
{
  /// The part of the lines that the path follows, from 0 to 1. Each line counts by its number of steps.
  double fraction = 0.0;
  std::string message;  ///< why the path ends earlier, in one line; empty if the fraction is 1
  /// The start and the states along the lines: rows of all variables. Angles continue without jumps by whole turns.
  std::vector<std::vector<double>> rows;
  std::uint64_t states_checked = 0;
  std::uint64_t revision = 0;  ///< of the checked scene
};

/// Computes the path: inverse kinematics continued along the lines from the start, then a check of all its motions in
/// one batch, by the motion rule. `scene`: that of the checker (StateChecker::setScene); this is not verified. If
/// `stop` returns true, the path ends early, with a message. Throws Error for an unknown group, a group with a joint
/// that drives only along its heading (Joint::diff_drive), a link that the group does not move, a row of the wrong
/// length, a start that is not finite or outside its limits, a waypoint that is not a rigid pose, no waypoint, lines of
/// too many steps, and steps or bounds that are not above 0. Errors of MotionChecker pass through. Thread-safe if each
/// call has a checker of its own.
CartesianPath followLines(const std::shared_ptr<const PlanningScene>& scene,
                          const std::shared_ptr<StateChecker>& checker, const CartesianQuery& query,
                          const std::function<bool()>& stop = {});
}  // namespace gpu_planning_scene::core
