#include "literature/poses.h"

#include <algorithm>
#include <cassert>  // FCL 0.7 uses assert without it
#include <cmath>
#include <optional>
#include <random>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/distance.h>

#include "base/parallel_for.h"
#include "literature/libraries/fcl_tree.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kTurnsAboutZ = 12;
constexpr int kTurnsAboutX = 5;
constexpr double kTurn = M_PI / 6.0;
constexpr int kSearchSteps = 300;

Eigen::Quaterniond randomTurn(std::mt19937_64& generator)
{
  std::normal_distribution<double> normal;
  const double w = normal(generator);
  const double x = normal(generator);
  const double y = normal(generator);
  return Eigen::Quaterniond(w, x, y, normal(generator)).normalized();
}

using Tree = fcl::BVHModel<fcl::RSS<double>>;

double surfaceDistance(const Tree& a, const Tree& b, const Isometry3d& b_in_a)
{
  fcl::DistanceResult<double> result;
  return fcl::distance(&a, Isometry3d(Isometry3d::Identity()), &b, b_in_a, fcl::DistanceRequest<double>(), result);
}

/// The distance of two surfaces changes by at most as much as b moves. So a step of the surplus never goes too far.
std::optional<Isometry3d> approached(const Tree& a, const Tree& b, Isometry3d pose, const Vector3d& towards_b,
                                     double clearance)
{
  for (int step = 0; step < kSearchSteps; ++step)
  {
    const double surplus = surfaceDistance(a, b, pose) - clearance;
    if (surplus <= 0.01 * clearance)
      return pose;
    pose.pretranslate(-surplus * towards_b);
    if (pose.translation().dot(towards_b) < 0.0)  // b passed by
      return std::nullopt;
  }
  return std::nullopt;
}
}  // namespace

std::vector<Isometry3d> posesAt(double distance, std::size_t count, std::uint64_t seed)
{
  std::mt19937_64 generator(seed);
  std::vector<Isometry3d> poses;
  for (std::size_t i = 0; i < count; ++i)
  {
    Isometry3d pose(randomTurn(generator));
    pose.pretranslate(randomTurn(generator) * (distance * Vector3d::UnitX()));
    poses.push_back(pose);
  }
  return poses;
}

std::vector<Isometry3d> turningPoses(double distance, std::uint64_t seed)
{
  std::vector<Isometry3d> poses;
  for (int i = 0; i < kTurnsAboutZ; ++i)
    for (int k = 0; k < kTurnsAboutX; ++k)
    {
      Isometry3d pose(Eigen::Translation3d(distance, 0.0, 0.0));
      pose.rotate(Eigen::AngleAxisd(kTurn * i, Vector3d::UnitZ()));
      pose.rotate(Eigen::AngleAxisd(kTurn * k, Vector3d::UnitX()));
      poses.push_back(pose);
    }
  std::shuffle(poses.begin(), poses.end(), std::mt19937_64(seed));
  return poses;
}

namespace
{
std::vector<Isometry3d> posesWithClearance(const Tree& a, const Tree& b, double size, double clearance,
                                           std::size_t count, std::uint64_t seed)
{
  const std::vector<Isometry3d> starts = posesAt(2.0 * size + clearance, count, seed);
  std::vector<std::optional<Isometry3d>> found(count);
  parallelFor(count, 4,
              [&](std::size_t begin, std::size_t end)
              {
                for (std::size_t i = begin; i < end; ++i)
                  found[i] = approached(a, b, starts[i], starts[i].translation().normalized(), clearance);
              });
  std::vector<Isometry3d> poses;
  for (const std::optional<Isometry3d>& pose : found)
    if (pose)
      poses.push_back(*pose);
  return poses;
}
}  // namespace

std::vector<std::vector<Isometry3d>> posesWithClearances(const Mesh& a, const Mesh& b, double size,
                                                         const std::vector<double>& clearances, std::size_t count,
                                                         std::uint64_t seed)
{
  const auto tree_a = fclTree<fcl::RSS<double>>(a);
  const auto tree_b = &a == &b ? tree_a : fclTree<fcl::RSS<double>>(b);
  std::vector<std::vector<Isometry3d>> poses;
  for (const double clearance : clearances)
    poses.push_back(posesWithClearance(*tree_a, *tree_b, size, clearance, count, seed));
  return poses;
}
}  // namespace gpu_planning_scene::core::literature
