#include "support/near_contact.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kReach = 0.1;  // metres: approximate relative displacement of two bodies per radian of joint travel
constexpr int kHalvings = 52;

/// A segment from a free to a colliding state. Positions on it run from 0 to 1.
struct Segment
{
  const double* from;
  const double* to;
  double free = 0.0;
  double colliding = 1.0;

  void appendState(double position, std::size_t width, std::vector<double>& states) const
  {
    for (std::size_t v = 0; v < width; ++v)
      states.push_back(from[v] + position * (to[v] - from[v]));
  }

  double length(std::size_t width) const
  {
    double sum = 0.0;
    for (std::size_t v = 0; v < width; ++v)
      sum += std::abs(to[v] - from[v]);
    return sum * kReach;
  }
};

/// Segments between random pairs of a free and a colliding state of `states`.
std::vector<Segment> makeSegments(const std::vector<double>& states, const std::vector<std::uint8_t>& valid,
                                  std::size_t count, std::mt19937_64& generator)
{
  const std::size_t width = states.size() / valid.size();
  std::vector<const double*> free;
  std::vector<const double*> colliding;
  for (std::size_t i = 0; i < valid.size(); ++i)
    (valid[i] ? free : colliding).push_back(&states[i * width]);
  if (free.empty() || colliding.empty())
    throw Error("no contact to be found: of " + std::to_string(valid.size()) + " random states " +
                std::to_string(free.size()) + " are free");
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < count; ++i)
    segments.push_back({free[generator() % free.size()], colliding[generator() % colliding.size()]});
  return segments;
}
}  // namespace

std::vector<double> nearContactStates(const TestScene& scene, std::size_t count, std::uint64_t seed)
{
  const std::size_t width = scene.lower.size();
  const std::size_t drawn = std::max<std::size_t>(count, 100);
  std::mt19937_64 generator(seed);
  CpuChecker checker(scene.scene);
  const std::vector<double> ends = scene.randomStates(drawn, seed);
  std::vector<Segment> segments = makeSegments(ends, checker.check(ends.data(), drawn).valid, count, generator);
  for (int i = 0; i < kHalvings; ++i)
  {
    std::vector<double> middles;
    for (const Segment& segment : segments)
      segment.appendState((segment.free + segment.colliding) / 2.0, width, middles);
    const BatchResult result = checker.check(middles.data(), count);
    for (std::size_t k = 0; k < count; ++k)
      (result.valid[k] ? segments[k].free : segments[k].colliding) = (segments[k].free + segments[k].colliding) / 2.0;
  }
  std::uniform_real_distribution<double> exponent(-10.0, -4.0);
  std::vector<double> states;
  for (std::size_t k = 0; k < count; ++k)
  {
    const double step = std::pow(10.0, exponent(generator)) / segments[k].length(width);
    const double position = k % 2 == 0 ? segments[k].free - step : segments[k].colliding + step;
    segments[k].appendState(std::clamp(position, 0.0, 1.0), width, states);
  }
  return states;
}
}  // namespace gpu_planning_scene::core
