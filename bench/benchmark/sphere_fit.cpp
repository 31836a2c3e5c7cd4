#include "benchmark/sphere_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Geometry>

namespace gpu_planning_scene::benchmark
{
namespace
{
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr std::size_t kSamples = 4000;
constexpr int kLloydRounds = 15;
constexpr int kBallRounds = 200;

/// Uniform over the surface, and up to as many of its vertices.
Points samplesOf(const Mesh& mesh)
{
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<double> areas;
  for (const auto& t : mesh.triangles)
    areas.push_back(
        (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm());
  Points points;
  if (*std::max_element(areas.begin(), areas.end()) > 0.0)
  {
    std::discrete_distribution<std::size_t> pick(areas.begin(), areas.end());
    for (std::size_t i = 0; i < kSamples; ++i)
    {
      const auto& t = mesh.triangles[pick(generator)];
      const double root = std::sqrt(share(generator));
      const double along = share(generator);
      points.push_back((1.0 - root) * mesh.vertices[t[0]] + root * (1.0 - along) * mesh.vertices[t[1]] +
                       root * along * mesh.vertices[t[2]]);
    }
  }
  const std::size_t step = mesh.vertices.size() / kSamples + 1;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step)
    points.push_back(mesh.vertices[i]);
  return points;
}

/// Each as far as can be from those before.
Points farPoints(const Points& points, std::size_t count)
{
  Points chosen = {points.front()};
  std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < count)
  {
    for (std::size_t i = 0; i < points.size(); ++i)
      nearest[i] = std::min(nearest[i], (points[i] - chosen.back()).squaredNorm());
    chosen.push_back(points[std::max_element(nearest.begin(), nearest.end()) - nearest.begin()]);
  }
  return chosen;
}

std::vector<Points> clustersOf(const Points& points, Points centers)
{
  std::vector<Points> clusters;
  for (int round = 0; round < kLloydRounds; ++round)
  {
    clusters.assign(centers.size(), {});
    for (const Vector3d& point : points)
    {
      std::size_t nearest = 0;
      for (std::size_t c = 1; c < centers.size(); ++c)
        if ((point - centers[c]).squaredNorm() < (point - centers[nearest]).squaredNorm())
          nearest = c;
      clusters[nearest].push_back(point);
    }
    for (std::size_t c = 0; c < centers.size(); ++c)
      if (!clusters[c].empty())
      {
        Vector3d sum = Vector3d::Zero();
        for (const Vector3d& point : clusters[c])
          sum += point;
        centers[c] = sum / static_cast<double>(clusters[c].size());
      }
  }
  return clusters;
}

const Vector3d& farthest(const Points& points, const Vector3d& from)
{
  return *std::max_element(points.begin(), points.end(),
                           [&](const Vector3d& a, const Vector3d& b)
                           { return (a - from).squaredNorm() < (b - from).squaredNorm(); });
}

Ball enclose(const Points& points)
{
  Vector3d center = points.front();
  for (int i = 1; i <= kBallRounds; ++i)
    center += (farthest(points, center) - center) / (i + 1.0);
  return {center.cast<float>(), static_cast<float>((farthest(points, center) - center).norm())};
}
}  // namespace

std::vector<Ball> fitBalls(const Mesh& mesh, std::size_t count)
{
  const Points points = samplesOf(mesh);
  std::vector<Ball> balls;
  for (const Points& cluster : clustersOf(points, farPoints(points, std::min(count, points.size()))))
    if (!cluster.empty())
      balls.push_back(enclose(cluster));
  return balls;
}

Ball boundingBall(const Mesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  const Vector3d center = box.center();
  return {center.cast<float>(), static_cast<float>((farthest(mesh.vertices, center) - center).norm())};
}
}  // namespace gpu_planning_scene::benchmark
