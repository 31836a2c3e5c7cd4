#pragma once

#include <memory>
#include <vector>

#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/robot_model.h"
#include "oracle/oracle.h"

namespace gpu_planning_scene::core::oracle
{
/// Where a robot's links are, in the planning frame, from its joints in quadruple precision.
std::vector<Motion> linkPoses(const RobotModel& robot, const double* state);

/// The contract's verdicts on whole states of a collision problem: its instances, pairs and paddings are taken as they
/// are, its tessellations are not looked at. Thread-safe.
class ProblemOracle
{
 public:
  explicit ProblemOracle(std::shared_ptr<const CollisionProblem> problem);
  ~ProblemOracle();

  /// Collides if a checked pair does, else Either if that is some pair's verdict, else Free. `link_poses`: of every
  /// link, in the planning frame.
  Verdict verdict(const std::vector<Motion>& link_poses) const;

  /// The least, over all checked pairs, of distance less required distance; from `limit` up, some number of at least
  /// `limit`.
  double clearance(const std::vector<Motion>& link_poses, double limit) const;

  /// Verdict on one checked or unchecked pair of instances: indices into `robot`, and into `robot` followed by `world`
  /// followed by `half_spaces`.
  Verdict pairVerdict(const std::vector<Motion>& link_poses, std::size_t first, std::size_t second) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};
}  // namespace gpu_planning_scene::core::oracle
