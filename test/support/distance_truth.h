#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/state_inspector.h"
#include "oracle/problem_oracle.h"

namespace gpu_planning_scene::core
{
/// How distances differ from the truth. Lengths in metres, the largest of all pairs.
struct DistanceFaults
{
  std::size_t compared = 0;
  std::size_t colliding = 0;    ///< of the compared pairs
  std::size_t missing = 0;      ///< pairs that are nearer than the range, but were not found
  std::size_t invented = 0;     ///< pairs that are farther, are not checked, or collide by only one of the two
  double distance_error = 0.0;  ///< NaN if one is NaN
  double point_error = 0.0;     ///< of the points' distance from their bodies, and from each other along the normal

  void addDistance(double error);
  void addPoint(double error);

  DistanceFaults& operator+=(const DistanceFaults& other);
};

/// The true distances of the bodies of a scene, by the oracle.
class DistanceTruth
{
 public:
  DistanceTruth(const std::shared_ptr<const PlanningScene>& scene, const std::string& group);

  /// Whether a body is a link or an attached object with a shape.
  bool isOfRobot(std::int32_t body) const;

  /// Compares all pairs of one state: number `state_number` of the states of `found`.
  DistanceFaults compareAllPairs(const double* state, const BodyDistances& found, std::size_t state_number,
                                 double range) const;

  /// How far a gradient is outside the slopes on both sides of the state, in metres per unit; the largest of all
  /// variables.
  double gradientError(const double* state, const BodyDistance& pair, const double* gradient) const;

  /// Whether two bodies collide still after the second one has moved by `length`, for twenty random directions.
  bool collidesAfter(const double* state, const BodyDistance& pair, double length, std::uint64_t seed) const;

 private:
  struct Placed
  {
    std::size_t tree;  // index into `shapes_`
    oracle::Motion pose;
    double padding;
  };

  std::vector<Placed> shapesOf(std::int32_t body, const std::vector<oracle::Motion>& link_poses) const;
  double distanceTo(const Placed& shape, const Eigen::Vector3d& point) const;
  double requiredOf(const BodyPair& bodies) const;

  std::shared_ptr<const PlanningScene> scene_;
  std::shared_ptr<const CollisionProblem> problem_;
  oracle::ProblemOracle oracle_;
  std::vector<std::unique_ptr<oracle::PreparedShape>> shapes_;  // one per tree, then one per half-space
};
}  // namespace gpu_planning_scene::core
