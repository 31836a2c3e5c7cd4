#pragma once

#include <array>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// The hull of up to four points and its point that is nearest to the origin: the inner step of the algorithm of
/// Gilbert, Johnson and Keerthi, "A Fast Procedure for Computing the Distance Between Complex Objects" (1988).
class Simplex
{
 public:
  explicit Simplex(const Eigen::Vector3d& point) : nearest_(point) { points_[0] = point; }

  /// Adds a point, finds the nearest point anew and keeps those points that it is a combination of. There are at most
  /// three before.
  void add(const Eigen::Vector3d& point);

  /// Whether there is room for another point; where there is none the origin is inside.
  bool full() const { return count_ == 4; }

  const Eigen::Vector3d& nearest() const { return nearest_; }

 private:
  /// The points of a face, by number, with their weights in its nearest point.
  struct Face
  {
    int count = 0;
    std::array<int, 4> points = {};
    Eigen::Vector3d nearest;
    double squared_distance;
  };

  void offer(Face& best, std::array<int, 4> points, int count, const Eigen::Vector3d& nearest) const;
  void offerSegment(Face& best, int a, int b) const;
  void offerTriangle(Face& best, int a, int b, int c) const;
  bool holdsOrigin() const;

  std::array<Eigen::Vector3d, 4> points_;
  int count_ = 1;
  Eigen::Vector3d nearest_;
};
}  // namespace gpu_planning_scene::core
