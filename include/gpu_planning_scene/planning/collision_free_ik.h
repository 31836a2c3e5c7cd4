#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/inverse_kinematics.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
struct CollisionFreeIkOptions
{
  IkOptions ik;                  ///< `max_solutions` and `max_attempts` count for each goal
  bool check_collisions = true;  ///< false: only kinematics and limits
};

enum class IkStatus
{
  Solved,
  NoSolution,  ///< no attempt fulfilled the constraints
  InCollision  ///< solutions were found, and all collide
};

/// The solutions of one goal.
struct CollisionFreeIkResult
{
  IkStatus status = IkStatus::NoSolution;
  std::string message;                      ///< the fault, in one line; empty if the status is Solved
  std::vector<std::vector<double>> states;  ///< rows of all variables; the nearest to the given state comes first
  std::vector<double> distances;            ///< of the rows from the given state: the norm over the group's variables
};

/// Inverse kinematics with collision checks, for many goals at once: candidates of all goals are checked together in
/// batches, and a goal whose candidate collides gets another one. `state`: where all searches begin, one value per
/// variable of the robot; variables outside the group keep its values. `scene`: that of the checker
/// (StateChecker::setScene); this is not verified. If `stop` returns true, goals without a solution get NoSolution. The
/// searches run on all cores, and each of them calls `stop` on its own thread. Thread-safe. Throws Error if the number
/// of values in `state` is wrong or a value is not valid; if a variable of the group that moves no link of a goal is
/// outside its limits by more than 1e-6 (radians, metres), because the search keeps its value; and the errors of
/// InverseKinematics and of StateChecker::check; errors of a goal name it if there are several.
std::vector<CollisionFreeIkResult> solveCollisionFree(const PlanningScene& scene, StateChecker& checker,
                                                      const std::string& group,
                                                      const std::vector<KinematicConstraints>& goals,
                                                      const std::vector<double>& state,
                                                      const CollisionFreeIkOptions& options,
                                                      const std::function<bool()>& stop = {});
}  // namespace gpu_planning_scene::core
