#include "benchmark/sphere_fit.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <random>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core::benchmark
{
namespace
{
using Eigen::Vector3d;

constexpr std::size_t kSamples = 2048;
constexpr std::size_t kCandidates = 512;
constexpr int kHalvingsOfBall = 14;
using Covered = std::bitset<kSamples>;

struct Sample
{
  Vector3d point;
  Vector3d outward;
};

struct Candidate
{
  Vector3d center;
  double radius;
};

double sixVolumes(const Mesh& mesh)
{
  double sum = 0.0;
  for (const auto& t : mesh.triangles)
    sum += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  return sum;
}

/// Samples with a uniform distribution over the surface.
std::vector<Sample> samplesOf(const Mesh& mesh)
{
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double sign = sixVolumes(mesh) < 0.0 ? -1.0 : 1.0;
  std::vector<Vector3d> normals;
  std::vector<double> areas;
  for (const auto& t : mesh.triangles)
  {
    normals.push_back(sign *
                      (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]));
    // The small term gives samples also for a mesh without area.
    areas.push_back(normals.back().norm() + 1e-15);
  }
  std::discrete_distribution<std::size_t> pick(areas.begin(), areas.end());
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < kSamples; ++i)
  {
    const std::size_t chosen = pick(generator);
    const auto& t = mesh.triangles[chosen];
    const double root = std::sqrt(share(generator));
    const double along = share(generator);
    samples.push_back({(1.0 - root) * mesh.vertices[t[0]] + root * (1.0 - along) * mesh.vertices[t[1]] +
                           root * along * mesh.vertices[t[2]],
                       normals[chosen].normalized()});
  }
  return samples;
}

/// Balls that touch the surface at a sample from inside and contain no other sample (Ma, Bae and Choi, "3D medial axis
/// point approximation using nearest neighbors and the normal field", 2012).
std::vector<Candidate> innerBalls(const std::vector<Sample>& samples, double largest)
{
  std::vector<Candidate> balls;
  for (std::size_t i = 0; i < kCandidates; ++i)
  {
    const Sample& at = samples[i * (kSamples / kCandidates)];
    double radius = largest;
    for (const Sample& other : samples)
    {
      const Vector3d back = at.point - other.point;
      const double depth = back.dot(at.outward);
      if (depth > 1e-9)
        radius = std::min(radius, back.squaredNorm() / (2.0 * depth));
    }
    balls.push_back({at.point - radius * at.outward, radius});
  }
  return balls;
}

/// Greedy set cover: indices of candidates that cover all samples when their radii are enlarged by `more`. Each step
/// takes the candidate that covers the most uncovered samples. Empty if more than `count` candidates are needed.
std::vector<std::size_t> cover(const std::vector<Candidate>& candidates, const std::vector<Sample>& samples,
                               double more, std::size_t count)
{
  std::vector<Covered> covers(candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c)
    for (std::size_t s = 0; s < kSamples; ++s)
      covers[c][s] = (samples[s].point - candidates[c].center).norm() <= candidates[c].radius + more;
  Covered left;
  left.set();
  std::vector<std::size_t> chosen;
  while (left.any())
  {
    const auto best =
        std::max_element(covers.begin(), covers.end(),
                         [&](const Covered& a, const Covered& b) { return (a & left).count() < (b & left).count(); });
    if (chosen.size() == count || (*best & left).none())
      return {};
    chosen.push_back(static_cast<std::size_t>(best - covers.begin()));
    left &= ~*best;
  }
  return chosen;
}
}  // namespace

std::vector<Ball> fitBalls(const Mesh& mesh, std::size_t count)
{
  const std::vector<Sample> samples = samplesOf(mesh);
  const double size = boundingBall(mesh).radius;
  const std::vector<Candidate> candidates = innerBalls(samples, size);
  double too_little = 0.0;
  double enough = 4.0 * size;  // a single candidate then covers all samples
  for (int i = 0; i < kHalvingsOfBall; ++i)
  {
    const double middle = 0.5 * (too_little + enough);
    (cover(candidates, samples, middle, count).empty() ? too_little : enough) = middle;
  }
  std::vector<Ball> balls;
  for (const std::size_t chosen : cover(candidates, samples, enough, count))
    balls.push_back({candidates[chosen].center.cast<float>(), static_cast<float>(candidates[chosen].radius + enough)});
  return balls;
}

Ball boundingBall(const Mesh& mesh)
{
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  const Vector3d center = box.center();
  double radius = 0.0;
  for (const Vector3d& vertex : mesh.vertices)
    radius = std::max(radius, (vertex - center).norm());
  return {center.cast<float>(), static_cast<float>(radius)};
}
}  // namespace gpu_planning_scene::core::benchmark
