#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
class KinematicChains;

struct IkOptions
{
  std::size_t max_solutions = 1;   ///< the search ends with this number of solutions
  std::size_t max_attempts = 200;  ///< the search ends after this number of start states
  /// Two solutions are distinct if a variable differs by at least this number (radians, metres).
  double least_difference = 0.1;
  std::uint64_t seed = 1;  ///< of the random start states; equal seeds give equal solutions
};

struct IkSolutions
{
  std::vector<std::vector<double>> states;  ///< rows of all variables, in the order in which the search found them
  std::size_t attempts = 0;
  /// The state that came nearest to fulfilling the constraints, for messages; empty if there is a solution.
  std::vector<double> nearest;
};

/// The link whose pose is wanted if a request names no link: the child link of the group's last joint. Throws Error if
/// the group's joints do not form one chain.
int tipOf(const RobotModel& robot, const Group& group);

/// Inverse kinematics: the values of a group's variables at which links fulfil constraints, for example have a pose.
/// The method is numerical: damped least squares from the given state, from states near it and from random states
/// within the limits. It takes trees of joints of all types, joints that mimic a joint of the group, and planar and
/// floating bases. It does not check collisions: see solveCollisionFree.
///
/// T. Sugihara: Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method. IEEE Transactions on
/// Robotics 27(5), 2011. Damped least squares: Y. Nakamura, H. Hanafusa: Inverse kinematic solutions with singularity
/// robustness for robot manipulator control. Journal of Dynamic Systems, Measurement, and Control 108(3), 1986.
///
/// Immutable and thread-safe.
class InverseKinematics
{
 public:
  /// Throws Error if the group is unknown, if the constraints are not valid (KinematicConstraints::validate), if no
  /// variable of the group moves one of their links, or if a range is of a variable outside the group.
  InverseKinematics(std::shared_ptr<const RobotModel> robot, const std::string& group,
                    KinematicConstraints constraints);
  ~InverseKinematics();

  /// Distinct states that fulfil the constraints within the limits of the variables. `state`: one value per variable of
  /// the robot; the search begins there. Variables that move no link of the constraints keep its values, or the nearest
  /// value of their range. Angles that may turn by whole turns are the ones nearest to `state`. If `stop` is given, the
  /// search ends when it returns true. No solution proves nothing, because the search is random. Throws Error if the
  /// options are not valid.
  IkSolutions solve(const double* state, const IkOptions& options, const std::function<bool()>& stop = {}) const;

  /// Moves the state by one descent, mostly to the nearest state that fulfils the constraints. Returns false if the
  /// descent ends elsewhere; then the state is changed too.
  bool project(double* state) const;

  /// How far a state is from the constraints; joint limits do not count.
  ConstraintViolation violation(const double* state) const;

  const KinematicConstraints& constraints() const { return constraints_; }
  /// The variables of the group that move a link of the constraints, ascending.
  const std::vector<int>& variables() const;
  const KinematicChains& chains() const { return *chains_; }

 private:
  KinematicConstraints constraints_;
  std::unique_ptr<const KinematicChains> chains_;
};
}  // namespace gpu_planning_scene::core
