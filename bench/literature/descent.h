#pragma once

#include <cstdint>
#include <vector>

/// How two trees are descended together.
namespace gpu_planning_scene::core::literature
{
/// Whether node a is opened, of two overlapping nodes of which at least one is no leaf: the one that is no leaf, else
/// the larger one.
inline bool opensFirst(bool leaf_a, bool leaf_b, double size_a, double size_b)
{
  return leaf_b || (!leaf_a && size_a > size_b);
}

struct Children
{
  std::uint32_t first;
  std::uint32_t count;
};

/// The children of a node, for a descent that opens both nodes at once. A leaf stands for its only child.
template <class Node>
Children childrenOrSelf(const std::vector<Node>& nodes, std::uint32_t node)
{
  return nodes[node].child == 0 ? Children{node, 1} : Children{nodes[node].child, 2};
}
}  // namespace gpu_planning_scene::core::literature
