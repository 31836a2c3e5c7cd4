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
  std::uint32_t number;  ///< of the pair, the same in all states
  std::uint32_t a;       ///< trees
  std::uint32_t b;
  Eigen::Isometry3d b_in_a;
};

/// The trees of a scene's collision problem, all shapes as triangles, and the pairs to traverse in some states: those
/// of which the boxes around the placed roots overlap.
struct PlacedPairs
{
  CpuForest forest;
  std::size_t trees;
  std::size_t nodes;
  std::vector<std::vector<std::uint16_t>> depths;  ///< of each node of each tree
  std::vector<PlacedPair> pairs;                   ///< state by state
  std::vector<std::size_t> first;                  ///< of each state; ends with the number of pairs

  std::size_t states() const { return first.size() - 1; }

  /// Brings each state's pairs into the order of `hits`, by pair number: most first.
  void sortByHits(const std::vector<std::size_t>& hits);
};

/// `states`: rows of the robot's variables. Throws Error for a scene with half-spaces, and one that always collides.
PlacedPairs placePairs(const TestScene& scene, const std::vector<double>& states);
}  // namespace gpu_planning_scene::core::volumes
