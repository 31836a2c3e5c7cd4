#include "volumes/boxes_and_spheres.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace gpu_planning_scene::core::volumes
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kBallSteps = 50;
constexpr Eigen::Index kMaxSamples = 96;  // points for the choice of an oriented box's axes
constexpr std::size_t kTurned = 3;        // number of candidate axes that are refined
constexpr double kPi = 3.14159265358979323846;

Vector3d sizesAlong(const Matrix3d& axes, const Points& points)
{
  Vector3d lower = axes.transpose() * points.col(0);
  Vector3d upper = lower;
  for (Eigen::Index i = 1; i < points.cols(); ++i)
  {
    const Vector3d point = axes.transpose() * points.col(i);
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  return upper - lower;
}

/// Rotates the axes in ever smaller steps to a local minimum of the box's surface. Returns the surface.
double improve(Matrix3d& axes, const Points& points)
{
  double best = surfaceMeasure(sizesAlong(axes, points));
  for (const double step : {kPi / 12.0, kPi / 40.0, kPi / 160.0})
    for (bool better = true; better;)
    {
      better = false;
      for (int turn = 0; turn < 6; ++turn)
      {
        const double angle = turn % 2 == 0 ? step : -step;
        const Matrix3d turned = axes * Eigen::AngleAxisd(angle, Vector3d::Unit(turn / 2)).toRotationMatrix();
        const double surface = surfaceMeasure(sizesAlong(turned, points));
        if (surface < best * (1.0 - 1e-6))
        {
          best = surface;
          axes = turned;
          better = true;
        }
      }
    }
  return best;
}

/// `points`: three per triangle.
std::vector<Triangle> trianglesOf(const Points& points)
{
  std::vector<Triangle> triangles;
  for (Eigen::Index i = 0; i + 2 < points.cols(); i += 3)
    triangles.push_back({points.col(i), points.col(i + 1), points.col(i + 2)});
  return triangles;
}

TriangleSpread spreadOf(const std::vector<Triangle>& triangles)
{
  TriangleSpread spread(triangles.front());
  for (std::size_t i = 1; i < triangles.size(); ++i)
    spread = TriangleSpread(spread, TriangleSpread(triangles[i]));
  return spread;
}

OrientedBoxVolume grown(OrientedBox box)
{
  box.half.array() += kGrowth;
  return {box};
}

/// At most kMaxSamples of the points.
Matrix3Xd sampled(const Points& points)
{
  const Eigen::Index stride = (points.cols() + kMaxSamples - 1) / kMaxSamples;
  Matrix3Xd samples(3, (points.cols() + stride - 1) / stride);
  for (Eigen::Index i = 0; i < samples.cols(); ++i)
    samples.col(i) = points.col(i * stride);
  return samples;
}
}  // namespace

/// After Badoiu and Clarkson, "Smaller Core-Sets for Balls" (2003): each step moves the centre towards the farthest
/// point.
Sphere Sphere::fit(const Points& points)
{
  Vector3d center = AxisBox::fit(points).center;
  Sphere best{center, std::numeric_limits<double>::infinity()};
  for (int step = 1; step <= kBallSteps; ++step)
  {
    Eigen::Index farthest = 0;
    const double radius = std::sqrt((points.colwise() - center).colwise().squaredNorm().maxCoeff(&farthest));
    if (radius < best.radius)
      best = {center, radius};
    center += (points.col(farthest) - center) / (step + 1.0);
  }
  best.radius += kGrowth;
  return best;
}

AxisBox AxisBox::fit(const Points& points)
{
  const Vector3d lower = points.rowwise().minCoeff();
  const Vector3d upper = points.rowwise().maxCoeff();
  return {0.5 * (lower + upper), 0.5 * (upper - lower) + Vector3d::Constant(kGrowth)};
}

FittedBox FittedBox::fit(const Points& points)
{
  const std::vector<Triangle> triangles = trianglesOf(points);
  return {grown(fitOrientedBox(spreadOf(triangles), triangles.data(), triangles.size()))};
}

RefinedOrientedBox RefinedOrientedBox::fit(const Points& points)
{
  const std::vector<Triangle> triangles = trianglesOf(points);
  const AxesChoice choice = axesChoice(spreadOf(triangles));
  const Matrix3Xd samples = sampled(points);
  Matrix3d best_axes;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(choice.count, kTurned); ++i)
  {
    Matrix3d axes = choice.axes[i];
    const double surface = improve(axes, samples);
    if (surface < least)
    {
      least = surface;
      best_axes = axes;
    }
  }
  // Removes the rounding errors of the repeated rotations.
  best_axes = Eigen::Quaterniond(best_axes).normalized().toRotationMatrix();
  return {grown(boxAlong(best_axes, triangles.data(), triangles.size()))};
}
}  // namespace gpu_planning_scene::core::volumes
