#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_forest.h"
#include "collision/problem/collision_problem.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core::volumes
{
/// A checked pair of two instances in a state.
struct PlacedPair
{
  std::uint32_t number;  ///< number of the pair, the same in all states
  std::uint32_t a;       ///< trees
  std::uint32_t b;
  Eigen::Isometry3d b_in_a;
};

/// The trees of a scene's collision problem, with all shapes as triangles, and the pairs to traverse in some states. A
/// pair is traversed if the axis-aligned bounding boxes of the placed trees overlap.
struct PlacedPairs
{
  CpuForest forest;
  std::size_t trees;
  std::size_t nodes;
  std::vector<std::vector<std::uint16_t>> depths;  ///< depth of each node of each tree
  std::vector<PlacedPair> pairs;                   ///< state by state
  std::vector<std::size_t> first;  ///< index of the first pair of each state; ends with the number of pairs

  std::size_t states() const { return first.size() - 1; }

  /// Sorts the pairs of each state by descending `hits`, which is indexed by pair number.
  void sortByHits(const std::vector<std::size_t>& hits);
};

/// `states`: rows of the robot's variables. Throws Error for a scene with half-spaces, or if every state collides.
PlacedPairs placePairs(const TestScene& scene, const std::vector<double>& states);
}  // namespace gpu_planning_scene::core::volumes
