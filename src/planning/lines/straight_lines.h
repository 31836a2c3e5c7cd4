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
  /// Lengths of a translation and of a rotation.
  struct Lengths
  {
    double metres;
    double radians;
  };

  /// `poses`: the first pose and the ends of the lines. `max_step`: of each step. `unit`: lengths that count the same
  /// for deviation(). Throws Error if the first pose and the ends of the steps are more than `max_poses` poses.
  StraightLines(const std::vector<Eigen::Isometry3d>& poses, const Lengths& max_step, const Lengths& unit,
                std::size_t max_poses);

  /// The ends of all steps, ascending, without 0. No step crosses the end of a line.
  const std::vector<double>& steps() const { return steps_; }

  Eigen::Isometry3d pose(double at) const;

  /// The difference of a pose from the nearest pose between `begin` and `end`, which belong to one line.
  Lengths deviation(const Eigen::Isometry3d& pose, double begin, double end) const;

 private:
  struct Line
  {
    Eigen::Isometry3d from;
    Eigen::Isometry3d to;
    double begin;  // in steps
    double end;
    Eigen::AngleAxisd rotation;  // from `from` to `to`
  };
  const Line& lineAt(double at) const;

  const Lengths unit_;
  std::vector<Line> lines_;
  std::vector<double> steps_;
};
}  // namespace gpu_planning_scene::core
