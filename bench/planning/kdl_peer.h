#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core::benchmark
{
/// KDL's numerical solver with joint limits (ChainIkSolverPos_NR_JL), on which MoveIt's default plugin is built. Its
/// first attempt begins at the given state, the others at random states.
class KdlPeer
{
 public:
  /// `urdf`: the text of the robot. `root`: the link at which the chain to the link `tip` begins. Throws Error if KDL
  /// does not read it.
  KdlPeer(const RobotModel& robot, const std::string& urdf, const std::string& root, int tip);
  ~KdlPeer();

  /// `pose`: of the tip, in the planning frame. `tolerance`: metres and radians.
  std::optional<std::vector<double>> solve(const Eigen::Isometry3d& pose, const std::vector<double>& state,
                                           double tolerance, std::size_t max_attempts);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core::benchmark
