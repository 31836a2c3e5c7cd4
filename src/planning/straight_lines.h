#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// A pose that moves on straight lines: a curve of poses over the number of steps done.
class StraightLines
{
 public:
  /// `poses`: the first pose and the ends of the lines.
  StraightLines(const std::vector<Eigen::Isometry3d>& poses, double max_step, double max_rotation_step);

  /// The ends of all steps, ascending, without 0. No step crosses the end of a line.
  const std::vector<double>& steps() const { return steps_; }

  Eigen::Isometry3d pose(double at) const;

  /// Distances of a pose from the lines' pose between `begin` and `end`, which belong to one line: of its origin from
  /// the line, and of its orientation from that at the nearest point of the line.
  struct Deviation
  {
    double distance;  ///< metres
    double angle;     ///< radians
  };
  Deviation deviation(const Eigen::Isometry3d& pose, double begin, double end) const;

 private:
  struct Line
  {
    Eigen::Isometry3d from;
    Eigen::Isometry3d to;
    double begin;  // in steps
    double end;
  };
  const Line& lineAt(double at) const;

  std::vector<Line> lines_;
  std::vector<double> steps_;
};
}  // namespace gpu_planning_scene::core
