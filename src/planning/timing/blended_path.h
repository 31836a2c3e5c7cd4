#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace gpu_planning_scene::core
{
/// A motion with constant acceleration. The arrays have one value per variable of the robot.
struct Phase
{
  Eigen::ArrayXd position;  ///< at the beginning, as the velocity
  Eigen::ArrayXd velocity;
  Eigen::ArrayXd acceleration;
  double seconds = 0.0;

  Eigen::ArrayXd positionAt(double time) const { return position + time * (velocity + 0.5 * time * acceleration); }
  Eigen::ArrayXd velocityAt(double time) const { return velocity + time * acceleration; }
};

/// The speeds along a path of straight segments, with a parabola or a stop at each waypoint.
class BlendedPath
{
 public:
  /// `waypoints`: at least one; neighbours differ. The limits are above 0. `max_deviation`: the largest deviation of a
  /// variable from the path, at least 0.
  BlendedPath(std::vector<Eigen::ArrayXd> waypoints, const Eigen::ArrayXd& max_velocity,
              const Eigen::ArrayXd& max_acceleration, double max_deviation);

  std::size_t waypoints() const { return waypoints_.size(); }
  /// The square of the speed at the waypoint, relative to the limits of velocity: 0 at a stop, at most 1. The lengths
  /// of its parabola are proportional to it.
  double size(std::size_t waypoint) const { return sizes_[waypoint]; }
  /// Whether the robot leaves the path on a parabola here. False at a stop, and where the path goes straight on.
  bool hasBlend(std::size_t waypoint) const { return sizes_[waypoint] > 0.0 && corner_seconds_[waypoint] > 0.0; }
  Phase blend(std::size_t waypoint) const;

  /// Makes the parabola smaller, or the waypoint a stop (0). The sizes of other parabolas may decrease too, because the
  /// robot may need more room to brake.
  void shrink(std::size_t waypoint, double factor) { largest_sizes_[waypoint] = factor * sizes_[waypoint]; }
  /// Call this after shrink().
  void computeSizes();

  /// The phases of the whole path, in order.
  std::vector<Phase> phases() const;

 private:
  struct Segment
  {
    Eigen::ArrayXd direction;  // its largest component is 1 or -1
    double length;
    double max_speed;
    double max_acceleration;
  };

  /// The part of a segment that the parabola at one of its ends replaces.
  double arm(const Segment& segment, std::size_t waypoint) const
  {
    return 0.5 * segment.max_speed * corner_seconds_[waypoint] * sizes_[waypoint];
  }
  void addSegment(std::size_t segment, std::vector<Phase>& phases) const;

  std::vector<Eigen::ArrayXd> waypoints_;
  std::vector<Segment> segments_;
  std::vector<double> corner_seconds_;  // of the parabola from and to the largest speeds; 0: the path goes straight on
  std::vector<double> largest_sizes_;
  std::vector<double> sizes_;
};
}  // namespace gpu_planning_scene::core
