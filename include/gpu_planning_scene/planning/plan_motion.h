#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ompl/base/Planner.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning/known_paths.h"
#include "gpu_planning_scene/planning/planner_factory.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A request for a motion. Each row has one value per variable of the robot, in radians and metres. Variables that are
/// not in the group keep their values from the start, and goals must have the same values for them.
struct PlanningQuery
{
  std::string group;
  std::vector<double> start;
  std::vector<std::vector<double>> goals;  ///< rows; the motion may end at any of them
  /// Further goals: the motion may end at any state that fulfils one of these constraints, for example a pose of a
  /// link. Inverse kinematics samples such states while the planner searches.
  std::vector<KinematicConstraints> goal_regions = {};
  KinematicConstraints path_constraints = {};  ///< hold along the whole motion, start and goal included
  /// Seconds for planning, including the check of the start and the goals; planners can take slightly longer.
  /// Simplification and the last check of the path follow. Each may take the largest of these three: the time that
  /// planning has left, a tenth of `seconds`, 0.1 s.
  double seconds = 5.0;
  bool simplify = true;
  /// Seconds, after simplification, in which PathOptimizer makes the path shorter; at least 0 and at most 1e9. It ends
  /// earlier if the path is the straight motion to the only goal. A path that ends at no goal stays as it is.
  double optimize_seconds = 0.0;
  MotionCheckerOptions motions;
  std::map<std::string, std::string> parameters = {};  ///< of the planner, by OMPL's names
  std::vector<std::string> projection = {};            ///< joints of the planner's projection; empty: the default
  std::optional<Eigen::AlignedBox3d> workspace = {};   ///< see GroupStateSpace
  /// Above 0: OMPL's random numbers come from this seed, and the batch planner searches once, unless `parameters` say
  /// otherwise. Calls with the same seed give the same path, unless a time limit ends a search or a proof, several
  /// searches run, or another thread of the process creates generators of OMPL meanwhile. Calls with a seed run one
  /// after the other.
  std::uint32_t seed = 0;
  /// A planner that can (TriesKnownPaths) tries these paths first, unless there is a seed. Add the path of the result
  /// (KnownPaths::add) if its status is Solved. Paths with another number of variables are left out. Null: none.
  std::shared_ptr<KnownPaths> known_paths = nullptr;
};

enum class PlanningStatus
{
  Solved,
  Approximate,  ///< no solution within the time; the path ends at the reached state nearest to a goal
  /// No solution, and no path that ends nearer to a goal; or the planner's path is not valid by the rule.
  NoSolution,
  StartInCollision,
  GoalInCollision,           ///< no goal is valid (free and within bounds), and the first collides
  OutOfBounds,               ///< the start is out of bounds; or no goal is valid, and the first is out of bounds
  GoalUnreachable,           ///< inverse kinematics found no state of a goal region
  StartViolatesConstraints,  ///< the start does not fulfil the path constraints
  GoalViolatesConstraints    ///< no goal is valid, and the first does not fulfil the path constraints
};

struct PlanningResult
{
  PlanningStatus status = PlanningStatus::NoSolution;
  std::string message;                         ///< the fault, in one line; empty if the status is Solved
  std::vector<std::vector<double>> waypoints;  ///< rows of all variables; none unless Solved or Approximate
  double planning_seconds = 0.0;        ///< with the check of the start and the goals, and the last check of the path
  double simplification_seconds = 0.0;  ///< with the time of PlanningQuery::optimize_seconds
  double checking_seconds = 0.0;        ///< of the checker, within the two times above, summed over all searches
  std::uint64_t states_checked = 0;
  std::uint64_t revision = 0;  ///< of the checked scene
};

/// Plans a motion with the planner that `factory` creates. `scene`: that of the checker (StateChecker::setScene); this
/// is not verified. `stop` is called from time to time; when it returns true, planning ends early, as soon as the
/// planner reacts. Thread-safe if each call has a checker of its own. Throws Error for an unknown group, parameter or
/// projection joint; for a row with a wrong length or a value that is not finite; for an angle of the start or a
/// goal beyond 1e6 rad (continuous and planar joints); for a goal that moves a variable outside the group; without a
/// goal; for goal regions or path constraints that are not valid or that the group cannot influence; and for times
/// beyond their limits.
/// Errors of GroupStateSpace and MotionChecker, and exceptions of the planner, pass through.
PlanningResult planMotion(const std::shared_ptr<const PlanningScene>& scene,
                          const std::shared_ptr<StateChecker>& checker, const PlanningQuery& query,
                          const PlannerFactory& factory, const std::function<bool()>& stop = {});
}  // namespace gpu_planning_scene::core
