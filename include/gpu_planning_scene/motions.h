#pragma once

#include <cstddef>
#include <vector>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene
{
/// The largest step of any variable between two states of a motion, above 0.
struct MotionSteps
{
  double revolute = 0.0;   ///< radians: angles, and quaternions by half the angle that they turn through
  double prismatic = 0.0;  ///< metres
};

/// Throws Error for a step that is not a finite number above 0.
void validateSteps(const MotionSteps& steps);

/// How far each joint of the robot moves on the straight way from one state to another; a mimic joint by what it makes
/// of its leader's. Fixed joints do not.
std::vector<JointWay> jointWays(const RobotModel& robot, const double* from, const double* to);

/// Into how many equal parts, at least 1, such a way is cut, so that no variable moves more than its step in one; as a
/// double, as there may be more than an integer holds.
double partsOfWay(const RobotModel& robot, const double* from, const double* to, const MotionSteps& steps);

/// Whether a whole turn of a continuous joint makes another state of it: where a joint mimics it by a multiplier that
/// is no whole number, or is a prismatic one.
bool hasNoPeriod(const RobotModel& robot, const Joint& joint);

/// The shorter way from one angle to another, from -half a turn to half a turn. Finite for all finite angles.
double shorterWay(double from, double to);

/// The state at `fraction` (0 to 1) of the straight way from one state to another: angles of continuous and planar
/// joints the shorter way round, quaternions by slerp. At 0 and 1 it is `from` and `to` themselves, bit by bit, so an
/// angle beyond half a turn jumps there by whole turns, which is the same place. A joint that hasNoPeriod
/// goes straight from value to value.
void interpolate(const RobotModel& robot, const double* from, const double* to, double fraction, double* state);

/// Motions as rows of states for a StateChecker, and what its answers say of the motions. As with MoveIt and OMPL, a
/// motion is looked at in steps: what lies between two free states of it is not looked at.
class MotionBatch
{
 public:
  /// `starts`, `ends`: `count` rows of all variables. Motion i becomes n + 1 states at the fractions 0, 1/n, ... 1,
  /// with the least n, at least 1, for which no variable moves more than its step. Throws Error for a step that is not
  /// a positive number, a value that is not finite, and more than `most_states` states, before it takes memory for
  /// them.
  MotionBatch(const RobotModel& robot, const double* starts, const double* ends, std::size_t count,
              const MotionSteps& steps, std::size_t most_states);

  const std::vector<double>& states() const { return states_; }
  std::size_t stateCount() const { return first_.back(); }

  struct Verdict
  {
    bool valid;                 ///< all its states are free
    double last_valid;          ///< fraction of the last state before the first hit; 0 where the start collides
    double first_invalid;       ///< fraction of the first state that collides; 1 where there is none
    std::size_t invalid_state;  ///< its row, in states() and in the result; where there is none, stateCount()
  };
  /// One per motion. `result`: the answer of a checker for states(). Throws std::logic_error where it is of others.
  std::vector<Verdict> verdicts(const BatchResult& result) const;

 private:
  std::vector<double> states_;
  std::vector<std::size_t> first_;  // row of each motion's first state, and the number of rows
};
}  // namespace gpu_planning_scene
