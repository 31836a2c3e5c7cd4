#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core::stability
{
/// Random numbers for one case.
class Random
{
 public:
  Random(std::uint64_t seed, std::size_t index)
  {
    std::seed_seq sequence{seed, static_cast<std::uint64_t>(index)};
    generator_.seed(sequence);
  }

  double uniform(double lower, double upper)
  {
    return std::uniform_real_distribution<double>(lower, upper)(generator_);
  }
  double logUniform(double lower, double upper) { return std::exp(uniform(std::log(lower), std::log(upper))); }
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(generator_); }
  bool coin() { return below(2) == 1; }

  Eigen::Vector3d inCube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Eigen::Vector3d direction() { return (rotation() * Eigen::Vector3d::UnitX()).normalized(); }
  Eigen::Quaterniond rotation()
  {
    std::normal_distribution<double> normal;
    const double x = normal(generator_);
    const double y = normal(generator_);
    const double z = normal(generator_);
    return Eigen::Quaterniond(normal(generator_), x, y, z).normalized();
  }
  /// Any rotation, and a translation of up to `distance` along each axis.
  Eigen::Isometry3d motion(double distance)
  {
    Eigen::Isometry3d pose(rotation());
    pose.translation() = inCube(distance);
    return pose;
  }

  /// A rotation by quarter turns, and a translation of up to `distance` along each axis in steps of 1/1024 m. Faces in
  /// a common plane along two axes remain exactly in a common plane, also in doubles.
  Eigen::Isometry3d alignedMotion(double distance)
  {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const int first = below(3);
    const int second = (first + 1 + below(2)) % 3;
    const double sign = coin() ? 1.0 : -1.0;
    pose.linear().col(0) = sign * Eigen::Vector3d::Unit(first);
    pose.linear().col(1) = (coin() ? 1.0 : -1.0) * Eigen::Vector3d::Unit(second);
    pose.linear().col(2) = pose.linear().col(0).cross(pose.linear().col(1));
    for (int i = 0; i < 3; ++i)
      pose.translation()[i] = std::round(1024.0 * uniform(-distance, distance)) / 1024.0;
    return pose;
  }

  /// 0, or plus or minus 1e-3, 1e-4, ... 1e-12 metres.
  double offset() { return powerOfTen(3, 12); }
  /// 0, or plus or minus 10^-first ... 10^-last.
  double powerOfTen(int first, int last)
  {
    const int exponent = first + below(last - first + 2);
    return exponent > last ? 0.0 : (coin() ? 1.0 : -1.0) * std::pow(10.0, -exponent);
  }

 private:
  std::mt19937_64 generator_;
};
}  // namespace gpu_planning_scene::core::stability
