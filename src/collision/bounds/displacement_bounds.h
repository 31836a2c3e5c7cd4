#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

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

/// How far a joint moves the points of a body, at most.
struct JointLever
{
  int joint;
  double per_metre;   ///< metres per metre of the joint's travel
  double per_radian;  ///< metres per radian of the joint's travel
};

/// The levers of a robot's instances. Computing them takes milliseconds, so they are kept for the next scene. One
/// caller at a time.
class JointLevers
{
 public:
  /// The joints between the root and an instance.
  struct Chain
  {
    struct Step
    {
      int link;                         // the child link of the joint
      std::optional<JointLever> lever;  // empty: the joint does not move
    };
    std::vector<Step> steps;  // from the instance's link up to the root
  };

  /// The chains of the problem's robot instances.
  std::vector<std::shared_ptr<const Chain>> of(const std::shared_ptr<const RobotModel>& robot,
                                               const CollisionProblem& problem);

 private:
  struct Known
  {
    Shape shape;
    Eigen::Isometry3d pose;
    int link;
    std::shared_ptr<const Chain> chain;
  };

  std::shared_ptr<const RobotModel> robot_;
  std::vector<Known> known_;  // of the latest problem
};

/// Upper bounds of the displacement of a robot's points while each joint moves by at most a given travel within its
/// limits. The bound is a sum over the joints: the joint's travel times the largest possible distance of the body from
/// the joint's axis (Schwarzer, Saha, Latombe 2002, "Exact collision checking of robot paths"). Reach provides these
/// distances. Immutable.
class DisplacementBounds
{
 public:
  /// Prepares the bounds of the problem's robot instances and self pairs.
  DisplacementBounds(const std::shared_ptr<const RobotModel>& robot, const CollisionProblem& problem,
                     JointLevers& levers);

  /// The number of margins: one for each robot instance, then one for each self pair.
  std::size_t count() const { return first_.size() - 1; }

  /// The margins of `count` states (rows of the robot's variables), in metres. For a robot instance: the largest
  /// displacement of its points in the planning frame. For a self pair: the largest displacement of the points of one
  /// instance relative to the other. The margins include rounding. A margin is kLargestMargin if there is no bound, and
  /// 0 if nothing moves. `around` must be valid, see validateNeighbourhood.
  Margins margins(const JointNeighbourhood& around, const double* states, std::size_t count) const;

 private:
  void margins(const JointTravel* travel, double* margins) const;

  std::size_t joints_;
  std::size_t variables_;
  std::vector<VariableRange> ranges_;
  std::vector<JointLever> levers_;
  std::vector<std::size_t> first_;  // index of the first lever of each margin; the last entry is the number of levers
};
}  // namespace gpu_planning_scene::core
