#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The distances that the pairs of a problem need in addition to their required distance, for each state of a batch.
struct Margins
{
  std::size_t width = 0;             ///< columns of a row: DisplacementBounds::count()
  std::vector<double> values;        ///< rows, metres
  std::vector<std::uint32_t> rows;   ///< one per state: index of the state's row
  std::vector<std::uint8_t> within;  ///< one per state: 0 if it is outside the joints' limits, without bounds

  const double* of(std::size_t state) const { return values.data() + rows[state] * width; }
};

/// Upper bounds of the displacement of a robot's points while each joint moves by at most a given travel within its
/// limits. The bound is a sum over the joints: the joint's travel times the largest distance from the joint's axis that
/// the body can have (Schwarzer, Saha, Latombe 2002, "Exact collision checking of robot paths"). Reach provides these
/// distances. Immutable.
class DisplacementBounds
{
 public:
  /// Prepares the bounds of the problem's robot instances and self pairs.
  DisplacementBounds(const RobotModel& robot, const CollisionProblem& problem);

  /// The number of margins: one for each robot instance, then one for each self pair.
  std::size_t count() const { return first_.size() - 1; }

  /// The margins of `count` states (rows of the robot's variables), in metres. For a robot instance: the largest
  /// displacement of its points in the planning frame. For a self pair: the largest displacement of the points of one
  /// instance relative to the other. The margins include rounding. A margin is kLargestLength if there is no bound, and
  /// 0 if nothing moves. `around` must be valid, see validateNeighbourhood.
  Margins margins(const JointNeighbourhood& around, const double* states, std::size_t count) const;

 private:
  void margins(const JointTravel* travel, double* margins) const;

  struct Term
  {
    int joint;
    double length;  // metres of displacement per metre of joint travel
    double angle;   // metres of displacement per radian of joint travel
  };

  std::size_t joints_;
  std::size_t variables_;
  std::vector<VariableRange> ranges_;
  std::vector<Term> terms_;
  std::vector<std::size_t> first_;  // index of the first term of each margin; the last entry is the number of terms
};
}  // namespace gpu_planning_scene::core
