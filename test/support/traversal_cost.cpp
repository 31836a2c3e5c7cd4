#include "support/traversal_cost.h"

#include <random>

#include "collision/geometry/cpu_box_pair.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr int kPoses = 12;
constexpr double kTrianglePair = 3.0;

Eigen::Vector3d vector(const std::array<float, 3>& values)
{
  return {values[0], values[1], values[2]};
}

double costInPose(const Forest& forest, std::uint32_t root_a, std::uint32_t root_b, const Eigen::Isometry3d& b_in_a)
{
  const BoxPairTest boxes(b_in_a.linear());
  double cost = 0.0;
  std::vector<std::array<std::uint32_t, 2>> stack = {{root_a, root_b}};
  while (!stack.empty())
  {
    const auto [index_a, index_b] = stack.back();
    stack.pop_back();
    const Node& a = forest.nodes[index_a];
    const Node& b = forest.nodes[index_b];
    const Eigen::Vector3d half_a = vector(a.half);
    const Eigen::Vector3d half_b = vector(b.half);
    cost += 1.0;
    if (!boxes.overlap(half_a, half_b, b_in_a * vector(b.center) - vector(a.center)))
      continue;
    if (a.count != 0 && b.count != 0)
      cost += kTrianglePair * a.count * b.count;
    else if (a.count == 0 && (b.count != 0 || half_a.squaredNorm() >= half_b.squaredNorm()))
    {
      stack.push_back({a.first, index_b});
      stack.push_back({a.first + 1, index_b});
    }
    else
    {
      stack.push_back({index_a, b.first});
      stack.push_back({index_a, b.first + 1});
    }
  }
  return cost;
}
}  // namespace

double traversalCost(const Forest& forest, const std::vector<Tessellation>& trees, std::size_t a, std::size_t b,
                     std::uint64_t seed)
{
  const auto bounds = [&](std::size_t tree)
  {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : trees[tree].mesh->vertices)
      box.extend(vertex);
    return box;
  };
  const Eigen::AlignedBox3d box_a = bounds(a);
  const Eigen::AlignedBox3d box_b = bounds(b);
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  double cost = 0.0;
  for (int i = 0; i < kPoses; ++i)
  {
    // b's centre lies near the surface of a's box, so that the traversal descends into both trees.
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond(normal(generator), normal(generator), normal(generator), normal(generator))
                        .normalized()
                        .toRotationMatrix();
    const Eigen::Vector3d direction =
        Eigen::Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
    pose.translation() = box_a.center() + 0.5 * direction.cwiseProduct(box_a.sizes() + box_b.sizes() / 2.0) -
                         pose.linear() * box_b.center();
    cost += costInPose(forest, forest.roots[a], forest.roots[b], pose);
  }
  return cost;
}
}  // namespace gpu_planning_scene::core
