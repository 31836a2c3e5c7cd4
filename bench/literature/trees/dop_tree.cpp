#include "literature/trees/dop_tree.h"

#include <algorithm>
#include <numeric>

// The construction is that of J. T. Klosowski, M. Held, J. S. B. Mitchell, H. Sowizral, K. Zikan, "Efficient Collision
// Detection Using Bounding Volume Hierarchies of k-DOPs" (1998): from the top, binary, split at the mean of the axis
// with the largest variance.
namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Vector3d;

/// The triangles of the second child begin at the result.
std::uint32_t* divided(const std::vector<Triangle>& triangles, std::uint32_t* begin, std::uint32_t* end)
{
  Vector3d mean = Vector3d::Zero();
  for (const std::uint32_t* i = begin; i != end; ++i)
    mean += centroid(triangles[*i]);
  mean /= static_cast<double>(end - begin);
  Vector3d variance = Vector3d::Zero();
  for (const std::uint32_t* i = begin; i != end; ++i)
    variance += (centroid(triangles[*i]) - mean).cwiseAbs2();
  int axis = 0;
  variance.maxCoeff(&axis);
  std::uint32_t* middle =
      std::partition(begin, end, [&](std::uint32_t t) { return centroid(triangles[t])[axis] < mean[axis]; });
  return middle == begin || middle == end ? begin + (end - begin) / 2 : middle;
}
}  // namespace

const DopAxes<9>& axesOf18Dop()
{
  static const DopAxes<9> axes = {Vector3d(1, 0, 0),  Vector3d(0, 1, 0),  Vector3d(0, 0, 1),
                                  Vector3d(1, 1, 0),  Vector3d(1, 0, 1),  Vector3d(0, 1, 1),
                                  Vector3d(1, -1, 0), Vector3d(1, 0, -1), Vector3d(0, 1, -1)};
  return axes;
}

const DopAxes<12>& axesOf24Dop()
{
  static const DopAxes<12> axes = []
  {
    DopAxes<12> made;
    std::copy(axesOf18Dop().begin(), axesOf18Dop().end(), made.begin());
    made[9] = Vector3d(1, 1, -1);
    made[10] = Vector3d(1, -1, 1);
    made[11] = Vector3d(-1, 1, 1);
    for (Vector3d& axis : made)
      axis.normalize();
    return made;
  }();
  return axes;
}

template <std::size_t kAxes>
DopTree<kAxes>::DopTree(const Mesh& mesh, const DopAxes<kAxes>& axes) : triangles_(trianglesOf(mesh))
{
  std::vector<std::uint32_t> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0U);
  nodes_.reserve(2 * triangles_.size());
  nodes_.emplace_back();
  build(0, order.data(), order.data() + order.size(), axes);
}

template <std::size_t kAxes>
void DopTree<kAxes>::build(std::uint32_t node, std::uint32_t* begin, std::uint32_t* end, const DopAxes<kAxes>& axes)
{
  if (end - begin == 1)
  {
    nodes_[node].triangle = *begin;
    for (std::size_t i = 0; i < kAxes; ++i)
    {
      const Triangle& t = triangles_[*begin];
      const auto [lower, upper] = std::minmax({axes[i].dot(t[0]), axes[i].dot(t[1]), axes[i].dot(t[2])});
      nodes_[node].slabs.lower[i] = lower;
      nodes_[node].slabs.upper[i] = upper;
    }
    return;
  }
  std::uint32_t* middle = divided(triangles_, begin, end);
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].child = child;
  nodes_.resize(nodes_.size() + 2);
  build(child, begin, middle, axes);
  build(child + 1, middle, end, axes);
  const Slabs<kAxes>& first = nodes_[child].slabs;
  const Slabs<kAxes>& second = nodes_[child + 1].slabs;
  for (std::size_t i = 0; i < kAxes; ++i)
  {
    nodes_[node].slabs.lower[i] = std::min(first.lower[i], second.lower[i]);
    nodes_[node].slabs.upper[i] = std::max(first.upper[i], second.upper[i]);
  }
}

template class DopTree<9>;
template class DopTree<12>;
}  // namespace gpu_planning_scene::core::literature
