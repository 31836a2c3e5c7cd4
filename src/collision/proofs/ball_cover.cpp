#include "collision/proofs/ball_cover.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <queue>
#include <utility>

#include "collision/geometry/median_split.h"
#include "collision/geometry/triangle_pair.h"

// The candidates for centres are points inside the shape. A candidate's ball may have the radius "depth of the centre +
// gap", so it reaches at most the gap beyond the surface. A greedy set cover finds balls for a gap; bisection finds the
// least gap for which the allowed number of balls suffices. The samples only choose the balls. Their radii are then
// computed from the parts of the whole shape, so a ball certainly contains its part. The header names the sources.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr std::size_t kCandidates = 1200;
constexpr std::size_t kSurfaceCandidates = 300;
constexpr std::size_t kSamples = 1500;  // of the surface, and as many of the solid
constexpr int kBisections = 9;
constexpr int kEnclosingSteps = 2000;
constexpr unsigned kPartsPerStopTest = 1000;
constexpr double kHalfDiagonal = 0.8660254037844387;  // of a cube of edge length 1
constexpr double kRounding = 1e-9;                    // metres: exceeds the rounding error of the radii

/// Keeps about `count` elements, evenly spread.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t count)
{
  const std::size_t step = std::max<std::size_t>(1, all.size() / count);
  std::vector<T> kept;
  for (std::size_t i = 0; i < all.size(); i += step)
    kept.push_back(all[i]);
  return kept;
}

/// Points inside the shape. Points of the surface too if the shape has surfaces that bound no solid, or few points
/// inside.
std::vector<SolidCell> candidatesOf(const CpuTree& tree, const ShapeSamples& samples)
{
  const bool is_closed = hasSolid(tree) && (!tree.mesh || tree.solid->isAllSolid());
  std::vector<SolidCell> candidates = thinned(samples.inside, kCandidates);
  if (!is_closed || candidates.size() < kSurfaceCandidates)
    for (const Vector3d& point : thinned(samples.points, kSurfaceCandidates))
      candidates.push_back({point, 0.0});
  return candidates;
}

/// For each candidate and each sample, the least gap for which the candidate's ball contains the sample.
class GapTable
{
 public:
  GapTable(const ShapeSamples& samples, const std::vector<SolidCell>& candidates) : candidates_(candidates.size())
  {
    const std::vector<Vector3d> points = thinned(samples.points, kSamples);
    const std::vector<SolidCell> cells = thinned(samples.cells, kSamples);
    words_ = (points.size() + cells.size() + kBits - 1) / kBits;
    gaps_.reserve(candidates_ * words_ * kBits);
    for (const SolidCell& candidate : candidates)
    {
      const auto add = [&](const Vector3d& point, double radius)
      { gaps_.push_back(static_cast<float>((point - candidate.center).norm() + radius - candidate.depth)); };
      for (const Vector3d& point : points)
        add(point, 0.0);
      for (const SolidCell& cell : cells)
        add(cell.center, kHalfDiagonal * samples.grid.cell);
      gaps_.resize((gaps_.size() + kBits - 1) / kBits * kBits, kNoSample);
    }
  }

  /// Indices of at most `most` candidates that contain all samples for a gap; empty if the greedy choice needs more.
  /// The greedy choice is lazy (Minoux, "Accelerated greedy algorithms for maximizing submodular set functions", 1978).
  std::vector<std::size_t> cover(float gap, std::size_t most) const
  {
    std::vector<std::uint64_t> contained(candidates_ * words_);
    for (std::size_t i = 0; i < contained.size(); ++i)
      contained[i] = atMost(&gaps_[i * kBits], gap);
    std::vector<std::uint64_t> left(words_);
    for (std::size_t w = 0; w < words_; ++w)
      left[w] = atMost(&gaps_[w * kBits], std::numeric_limits<float>::max());
    const auto count_new = [&](std::size_t c)
    {
      std::size_t count = 0;
      for (std::size_t w = 0; w < words_; ++w)
        count += std::bitset<64>(contained[c * words_ + w] & left[w]).count();
      return count;
    };
    // A candidate never gains new samples, so an old count is an upper bound.
    std::priority_queue<std::pair<std::size_t, std::size_t>> counts;
    for (std::size_t c = 0; c < candidates_; ++c)
      counts.push({count_new(c), c});
    std::vector<std::size_t> chosen;
    while (std::any_of(left.begin(), left.end(), [](std::uint64_t word) { return word != 0; }))
    {
      if (counts.empty())
        return {};
      const auto [bound, best] = counts.top();
      counts.pop();
      const std::size_t count = count_new(best);
      if (count < bound && !counts.empty() && count < counts.top().first)
      {
        counts.push({count, best});
        continue;
      }
      if (count == 0 || chosen.size() == most)
        return {};
      chosen.push_back(best);
      for (std::size_t w = 0; w < words_; ++w)
        left[w] &= ~contained[best * words_ + w];
    }
    return chosen;
  }

 private:
  static constexpr std::size_t kBits = 64;
  static constexpr float kNoSample = std::numeric_limits<float>::infinity();

  /// One bit for each of kBits gaps: 1 if it is at most `gap`. Compilers vectorise the comparisons; a product then
  /// gathers the lowest bits of eight bytes in one byte.
  static std::uint64_t atMost(const float* gaps, float gap)
  {
    std::array<std::uint8_t, kBits> bytes;
    for (std::size_t i = 0; i < kBits; ++i)
      bytes[i] = gaps[i] <= gap ? 1 : 0;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < kBits; i += 8)
    {
      std::uint64_t eight;
      std::memcpy(&eight, &bytes[i], sizeof eight);
      bits = bits << 8 | (eight * 0x0102040810204080U) >> 56;
    }
    return bits;
  }

  std::size_t candidates_;
  std::size_t words_;
  std::vector<float> gaps_;  // candidates_ rows of words_ * kBits gaps; kNoSample at the end of a row
};

/// A ball that is being fitted.
struct Fit
{
  Vector3d center;
  double depth;  // metres: of the centre below the surface; 0 if it is not known to be inside
  double outer = 0.0;
};

/// The centre of a small ball around points (Badoiu and Clarkson, "Smaller core-sets for balls", 2003).
Vector3d enclosingCenter(const std::vector<Vector3d>& points, const Stopped& stopped)
{
  StopTest end_if_stopped(stopped);
  Vector3d center = points.front();
  for (int step = 1; step <= kEnclosingSteps; ++step)
  {
    end_if_stopped();
    const auto farthest = std::max_element(points.begin(), points.end(),
                                           [&center](const Vector3d& a, const Vector3d& b)
                                           { return (a - center).squaredNorm() < (b - center).squaredNorm(); });
    center += (*farthest - center) / (step + 1.0);
  }
  return center;
}

/// Makes the balls contain a part of the shape. If no ball contains it, the ball that then reaches least beyond the
/// surface grows. `radius_from` returns the radius at which a ball around a centre contains the part.
template <class RadiusFrom>
void contain(std::vector<Fit>& fits, const RadiusFrom& radius_from)
{
  Fit* best = &fits.front();
  double least = std::numeric_limits<double>::max();
  double radius = 0.0;
  for (Fit& fit : fits)
  {
    const double needed = radius_from(fit.center);
    if (needed <= fit.outer)
      return;
    if (needed - fit.depth < least)
    {
      least = needed - fit.depth;
      best = &fit;
      radius = needed;
    }
  }
  best->outer = radius;
}

CoverBall certified(const CpuTree& tree, const ShapeSamples& samples, const Fit& fit, double sagitta)
{
  CoverBall ball{fit.center, fit.outer + sagitta + kRounding, fit.center, 0.0};
  // A curved primitive is larger than its triangles, by at most the sagitta.
  const double depth = (1.0 - 1e-6) * distanceFromSurface(tree, fit.center) - sagitta - kRounding;
  if (depth > 0.0 && hasSolid(tree) && insideSolid(tree, fit.center))
    ball.inner = depth;
  else
    ball.witness = *std::min_element(samples.points.begin(), samples.points.end(),
                                     [&fit](const Vector3d& a, const Vector3d& b)
                                     { return (a - fit.center).squaredNorm() < (b - fit.center).squaredNorm(); });
  return ball;
}
}  // namespace

BallCover coverOf(const CpuTree& tree, const ShapeSamples& samples, double sagitta, const Stopped& stopped)
{
  StopTest end_if_stopped(stopped);
  StopTest end_part_if_stopped(stopped, kPartsPerStopTest);
  const std::vector<SolidCell> candidates = candidatesOf(tree, samples);
  const GapTable gaps(samples, candidates);
  BallCover cover;
  cover.layer = hasSolid(tree) ? 2.0 * kHalfDiagonal * samples.grid.cell + sagitta : 0.0;
  for (std::size_t level = 0; level < kCoverBalls.size(); ++level)
  {
    std::vector<Fit> fits;
    if (level == 0)
      fits.push_back({enclosingCenter(samples.points, stopped), 0.0});
    else
    {
      float low = 0.0F;
      auto high = static_cast<float>(2.0 * cover.levels[0].front().outer);
      std::vector<std::size_t> chosen{0};
      for (int step = 0; step < kBisections; ++step)
      {
        end_if_stopped();
        const float gap = 0.5F * (low + high);
        const std::vector<std::size_t> found = gaps.cover(gap, kCoverBalls[level]);
        (found.empty() ? low : high) = gap;
        if (!found.empty())
          chosen = found;
      }
      for (const std::size_t candidate : chosen)
        fits.push_back({candidates[candidate].center, candidates[candidate].depth});
    }
    for (const Triangle& piece : samples.pieces)
    {
      end_part_if_stopped();
      contain(fits,
              [&piece](const Vector3d& center)
              {
                return std::sqrt(std::max({(piece[0] - center).squaredNorm(), (piece[1] - center).squaredNorm(),
                                           (piece[2] - center).squaredNorm()}));
              });
    }
    for (const SolidCell& cell : samples.cells)
      contain(
          fits,
          [&](const Vector3d& center) { return (cell.center - center).norm() + kHalfDiagonal * samples.grid.cell; });
    sortBySplits(fits.begin(), fits.end(), [](const Fit& fit) { return fit.center; });
    for (const Fit& fit : fits)
    {
      end_if_stopped();
      cover.levels[level].push_back(certified(tree, samples, fit, sagitta));
    }
  }
  if (hasSolid(tree) && (!tree.mesh || (tree.solid->components.size() == 1 && tree.solid->isAllSolid())))
    for (const auto& level : cover.levels)
      for (const CoverBall& ball : level)
        cover.thickness = std::max(cover.thickness, ball.inner);
  return cover;
}
}  // namespace gpu_planning_scene::core
