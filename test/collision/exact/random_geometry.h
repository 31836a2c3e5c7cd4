#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace gpu_planning_scene::core
{
/// Random numbers and directions. The same seed gives the same ones.
class RandomGeometry
{
 public:
  explicit RandomGeometry(std::uint64_t seed) : generator_(seed) {}

  std::uint64_t number() { return generator_(); }
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(generator_); }
  /// Uniform in its logarithm.
  double size(double least, double most) { return std::exp(uniform(std::log(least), std::log(most))); }
  /// Of unit length.
  Eigen::Vector3d direction()
  {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(generator_), normal(generator_), normal(generator_)).normalized();
  }

 private:
  std::mt19937_64 generator_;
};
}  // namespace gpu_planning_scene::core
