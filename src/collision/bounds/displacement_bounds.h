#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// By how much more than their required distance the pairs of a problem are to be apart, for each state of a batch.
struct Margins
{
  std::size_t width = 0;            ///< of a row: as DisplacementBounds::count()
  std::vector<double> values;       ///< rows, metres
  std::vector<std::uint32_t> rows;  ///< one per state: which of those is its
  std::vector<std::uint8_t>
      within;  ///< one per state: 0 where it is outside the joints' limits, so that they are no bounds

  const double* of(std::size_t state) const { return values.data() + rows[state] * width; }
};

/// How far points of a robot can move while its joints move by no more than given ways, within their limits. Bounds
/// that hold: the sum over joints of the way times the largest distance from the joint's axis to which the joints
/// beyond it can take the body (Schwarzer, Saha, Latombe 2002, "Exact collision checking of robot paths"); the
/// distances come from Reach. Immutable.
class DisplacementBounds
{
 public:
  /// Of the problem's robot instances and self pairs.
  DisplacementBounds(const RobotModel& robot, const CollisionProblem& problem);

  /// How many margins there are: one for each robot instance, then one for each self pair.
  std::size_t count() const { return first_.size() - 1; }

  /// For `count` rows of the robot's variables. In metres: the largest displacement of a point of each robot instance
  /// in the planning frame, and of each self pair that of the points of one against the other. With what rounding
  /// loses; kLargestLength where there is no bound. 0 where nothing moves. `around` fits: see
  /// validateNeighbourhood.
  Margins margins(const JointNeighbourhood& around, const double* states, std::size_t count) const;

 private:
  void margins(const JointTravel* travel, double* margins) const;

  struct Term
  {
    int joint;
    double length;  // metres per metre
    double angle;   // metres per radian
  };

  std::size_t joints_;
  std::size_t variables_;
  std::vector<VariableRange> ranges_;
  std::vector<Term> terms_;
  std::vector<std::size_t> first_;  // term of each margin, and the number of terms
};
}  // namespace gpu_planning_scene::core
