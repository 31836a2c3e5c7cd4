#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "collision/bounds/joint_levers.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The margin of a pair without a bound, in metres: more than any distance of two bodies.
constexpr double kLargestMargin = 1e12;

/// The distances that the pairs of a problem need in addition to their required distance, for each state of a batch.
struct Margins
{
  std::size_t width = 0;             ///< columns of a row: DisplacementBounds::count()
  std::vector<double> values;        ///< rows, metres
  std::vector<std::uint32_t> rows;   ///< one per state: index of the state's row
  std::vector<std::uint8_t> within;  ///< one per state; 0: outside the joint limits, so without bounds

  const double* of(std::size_t state) const { return values.data() + rows[state] * width; }
};

/// Upper bounds of the displacement of a robot's points while each joint moves by at most a given travel within its
/// limits. The bound is a sum over the joints: the joint's travel times the largest distance of the body from the
/// joint's axis (Schwarzer, Saha, Latombe 2002, "Exact collision checking of robot paths"). Two bounds of this distance
/// are known, and the smaller one is taken: that of LeverChain, which holds anywhere within the limits, and that of
/// StateBox, which is smaller if the arm is bent. Immutable.
class DisplacementBounds
{
 public:
  /// Prepares the bounds of the problem's robot instances and self pairs.
  DisplacementBounds(const std::shared_ptr<const RobotModel>& robot, const CollisionProblem& problem,
                     JointLevers& levers);

  /// The number of margins: one for each robot instance, then one for each self pair.
  std::size_t count() const { return moving_.size(); }

  /// The margins of `count` states (rows of the robot's variables), in metres. For a robot instance: the largest
  /// displacement of its points in the planning frame. For a self pair: the largest displacement of the points of one
  /// instance relative to the other. The margins include rounding. A margin is kLargestMargin if there is no bound, and
  /// 0 if nothing moves. States with the same row of `around` have the same margins. `around` must be valid, see
  /// validateNeighbourhood.
  Margins margins(const JointNeighbourhood& around, const double* states, std::size_t count) const;

 private:
  /// The steps that move an instance, or one of two instances relative to the other: the first ones of their chains.
  struct Moving
  {
    std::size_t chain;
    std::size_t steps;
    std::size_t other_chain;
    std::size_t other_steps;
  };

  std::shared_ptr<const RobotModel> robot_;
  std::vector<VariableRange> ranges_;
  std::vector<std::shared_ptr<const LeverChain>> chains_;
  std::vector<std::size_t> first_;  // of each chain: the index of its first sum; a chain has one sum more than steps
  std::vector<Moving> moving_;      // of each margin
};
}  // namespace gpu_planning_scene::core
