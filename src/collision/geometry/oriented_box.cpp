#include "collision/geometry/oriented_box.h"

#include <algorithm>
#include <limits>

#include <Eigen/Eigenvalues>

// Fits an oriented box to triangles: builds the box along each of a few candidate axes, among them the eigenvectors of
// the corners' covariance (Gottschalk, Lin and Manocha, "OBBTree", 1996), and keeps the box of least surface.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

// A triangle whose height is below about this share of its edges has no reliable normal.
constexpr double kSliver = 1e-9;

// Three steps round: the coordinates of the corners along axes that are orthonormal up to rounding, the centre of the
// box, and the coordinates of a point relative to this centre. Each error is at most a few units in the last place of
// the farthest corner; 32 units are several times their sum.
constexpr double kBoxRounding = 32.0 * std::numeric_limits<double>::epsilon();

/// Right-handed axes: z has unit length; x is the part of `direction` that is orthogonal to z. `direction` must not be
/// parallel to z.
Matrix3d axesFrom(const Vector3d& direction, const Vector3d& z)
{
  Matrix3d axes;
  axes.col(0) = (direction - z.dot(direction) * z).normalized();
  axes.col(1) = z.cross(axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1)).normalized();
  return axes;
}
}  // namespace

TriangleSpread::TriangleSpread(const Triangle& triangle)
  : corners_(3.0), mean_((triangle[0] + triangle[1] + triangle[2]) / 3.0)
{
  for (const Vector3d& corner : triangle)
    scatter_.noalias() += (corner - mean_) * (corner - mean_).transpose();
  std::array<Vector3d, 3> edges = {triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]};
  std::sort(edges.begin(), edges.end(),
            [](const Vector3d& a, const Vector3d& b) { return a.squaredNorm() < b.squaredNorm(); });
  edge_ = edges[1];
  normal_ = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

TriangleSpread::TriangleSpread(const TriangleSpread& a, const TriangleSpread& b) : corners_(a.corners_ + b.corners_)
{
  const double share = b.corners_ / corners_;
  const Vector3d between = b.mean_ - a.mean_;
  mean_ = a.mean_ + share * between;
  scatter_ = a.scatter_ + b.scatter_ + a.corners_ * share * between * between.transpose();
  const TriangleSpread& larger = a.normal_.squaredNorm() >= b.normal_.squaredNorm() ? a : b;
  edge_ = larger.edge_;
  normal_ = larger.normal_;
}

Matrix3d TriangleSpread::mainAxes() const
{
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(scatter_);
  return axesFrom(solver.eigenvectors().col(0), solver.eigenvectors().col(2));
}

AxesChoice axesChoice(const TriangleSpread& spread)
{
  AxesChoice choice{{Matrix3d::Identity(), spread.mainAxes()}, 2};
  const double area = spread.normal().norm();
  if (!(area > kSliver * spread.edge().squaredNorm()))
    return choice;
  const Vector3d normal = spread.normal() / area;
  int nearest;
  normal.cwiseAbs().minCoeff(&nearest);
  choice.axes[choice.count++] = axesFrom(spread.edge().normalized(), normal);
  choice.axes[choice.count++] = axesFrom(Vector3d::Unit(nearest), normal);
  return choice;
}

OrientedBox boxAlong(const Matrix3d& axes, const Triangle* triangles, std::size_t count)
{
  Vector3d lower = axes.transpose() * triangles[0][0];
  Vector3d upper = lower;
  for (std::size_t i = 0; i < count; ++i)
    for (const Vector3d& corner : triangles[i])
    {
      const Vector3d along = axes.transpose() * corner;
      lower = lower.cwiseMin(along);
      upper = upper.cwiseMax(along);
    }
  const double rounding = kBoxRounding * lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).norm();
  return {axes, axes * (0.5 * (lower + upper)), 0.5 * (upper - lower) + Vector3d::Constant(rounding)};
}

OrientedBox fitOrientedBox(const TriangleSpread& spread, const Triangle* triangles, std::size_t count)
{
  const AxesChoice choice = axesChoice(spread);
  OrientedBox best = boxAlong(choice.axes[0], triangles, count);
  for (std::size_t i = 1; i < choice.count; ++i)
  {
    const OrientedBox box = boxAlong(choice.axes[i], triangles, count);
    if (surfaceMeasure(box.half) < surfaceMeasure(best.half))
      best = box;
  }
  return best;
}
}  // namespace gpu_planning_scene::core
