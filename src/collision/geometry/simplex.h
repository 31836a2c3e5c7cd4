#pragma once

#include <array>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// The convex hull of up to four points, and the point of the hull that is nearest to the origin. This is the inner
/// step of the algorithm of Gilbert, Johnson and Keerthi, "A Fast Procedure for Computing the Distance Between Complex
/// Objects" (1988).
class Simplex
{
 public:
  explicit Simplex(const Eigen::Vector3d& point) : nearest_(point) { points_[0] = point; }

  /// Adds a point to at most three. Finds the new nearest point, and keeps only the points of the face that contains
  /// it.
  void add(const Eigen::Vector3d& point);

  /// Whether the simplex has four points and so has no room for another one. The origin is then inside it.
  bool full() const { return count_ == 4; }

  const Eigen::Vector3d& nearest() const { return nearest_; }

  /// The points of the face that contains the nearest point.
  int count() const { return count_; }
  const Eigen::Vector3d& point(int i) const { return points_[i]; }

 private:
  /// A face of the hull: the numbers of its points, and its point that is nearest to the origin.
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
