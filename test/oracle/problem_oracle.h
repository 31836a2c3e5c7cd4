#pragma once

#include <map>
#include <memory>
#include <vector>

#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/robot_model.h"
#include "oracle/oracle.h"

namespace gpu_planning_scene::core::oracle
{
/// The poses of a robot's links in the planning frame, computed in quadruple precision.
std::vector<Motion> linkPoses(const RobotModel& robot, const double* state);

/// The contract's verdicts on whole states of a collision problem. It uses the problem's instances, pairs and paddings,
/// and ignores its tessellations. Thread-safe.
class ProblemOracle
{
 public:
  explicit ProblemOracle(std::shared_ptr<const CollisionProblem> problem);
  ~ProblemOracle();

  /// Collides if a checked pair collides; else Either if a checked pair has this verdict; else Free. `link_poses`: of
  /// every link, in the planning frame.
  Verdict verdict(const std::vector<Motion>& link_poses) const;

  /// The smallest value of distance minus required distance over all checked pairs. If it is at least `limit`, the
  /// result is some value of at least `limit`.
  double clearance(const std::vector<Motion>& link_poses, double limit) const;

  /// The same for each pair of bodies with a checked pair; those that are not below `limit` are left out. The bodies
  /// ascend.
  std::map<BodyPair, double> clearances(const std::vector<Motion>& link_poses, double limit) const;

  /// The same for one pair of bodies, which must ascend.
  double clearanceOf(const BodyPair& bodies, const std::vector<Motion>& link_poses, double limit) const;

  /// The verdict on a pair of instances, whether checked or not. `first` is an index into `robot`; `second` is an index
  /// into the concatenation of `robot`, `world` and `half_spaces`.
  Verdict pairVerdict(const std::vector<Motion>& link_poses, std::size_t first, std::size_t second) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};
}  // namespace gpu_planning_scene::core::oracle
