#include "literature/trees/oriented_boxes.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Eigenvalues>

#include "literature/descent.h"
#include "literature/shared_tree.h"

// S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree: A Hierarchical Structure for Rapid Interference Detection" (1996),
// with the constants of their program RAPID. A box has the axes of the covariance of its triangles' area. (The paper
// takes the area of their convex hull; the area of the triangles themselves costs less, and it is what RAPID takes.)
// The triangles of a node are divided by their centroids at the mean, across the longest axis of the box that divides
// them. The boxes' relative frames are composed on the way down, in double. Domain: any mesh, surfaces only. Two edges
// that are almost parallel have no common perpendicular, so RAPID adds 1e-6 to the absolute value of each number of the
// rotation. This makes each box larger by a millionth of the other box.
namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Node = OrientedBoxTree::Node;

/// Covariance of the points of all triangles, weighted by their area; of the corners if there is no area.
Matrix3d covarianceOf(const std::vector<Triangle>& triangles, const std::uint32_t* begin, const std::uint32_t* end)
{
  double weights = 0.0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  const auto add = [&](double weight, const Triangle& t)
  {
    const Vector3d middle = centroid(t);
    weights += weight;
    first += weight * middle;
    Matrix3d moment = 9.0 * middle * middle.transpose();
    for (const Vector3d& corner : t)
      moment += corner * corner.transpose();
    second += weight / 12.0 * moment;
  };
  for (const std::uint32_t* i = begin; i != end; ++i)
    add(0.5 * (triangles[*i][1] - triangles[*i][0]).cross(triangles[*i][2] - triangles[*i][0]).norm(), triangles[*i]);
  if (!(weights > 0.0))
    for (const std::uint32_t* i = begin; i != end; ++i)
      add(1.0, triangles[*i]);
  return second / weights - first * first.transpose() / (weights * weights);
}

Matrix3d axesOf(const Matrix3d& covariance)
{
  Matrix3d axes = Eigen::SelfAdjointEigenSolver<Matrix3d>(covariance).eigenvectors();
  if (axes.determinant() < 0.0)
    axes.col(0) = -axes.col(0);
  return axes;
}

class OrientedBoxes : public TreeMethod
{
 public:
  OrientedBoxes(OrientedBoxTreePtr a, OrientedBoxTreePtr b, double epsilon, Search search)
    : TreeMethod(a->triangles(), b->triangles(), search), a_(std::move(a)), b_(std::move(b)), epsilon_(epsilon)
  {
  }

 private:
  bool traverse() override
  {
    const Node& a = a_->nodes().front();
    const Node& b = b_->nodes().front();
    const Matrix3d rotation = a.rotation.transpose() * pose().linear() * b.rotation;
    return traverse(a, b, rotation, a.rotation.transpose() * (pose() * b.center - a.center));
  }

  /// `rotation`, `translation`: the frame of b's box in the frame of a's box.
  bool traverse(const Node& a, const Node& b, const Matrix3d& rotation, const Vector3d& translation)
  {
    countVolumeTest();
    if (boxesApart(rotation, translation, a.half, b.half, epsilon_))
      return false;
    if (a.child == 0 && b.child == 0)
      return testLeaves(a.triangle, b.triangle);
    if (opensFirst(a.child == 0, b.child == 0, a.half.maxCoeff(), b.half.maxCoeff()))
    {
      for (std::uint32_t i = 0; i < 2; ++i)
      {
        const Node& child = a_->nodes()[a.child + i];
        if (traverse(child, b, child.rotation.transpose() * rotation,
                     child.rotation.transpose() * (translation - child.center)))
          return true;
      }
      return false;
    }
    for (std::uint32_t i = 0; i < 2; ++i)
    {
      const Node& child = b_->nodes()[b.child + i];
      if (traverse(a, child, rotation * child.rotation, rotation * child.center + translation))
        return true;
    }
    return false;
  }

  OrientedBoxTreePtr a_;
  OrientedBoxTreePtr b_;
  double epsilon_;
};
}  // namespace

OrientedBoxTree::OrientedBoxTree(const Mesh& mesh) : triangles_(trianglesOf(mesh))
{
  std::vector<std::uint32_t> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0U);
  nodes_.reserve(2 * triangles_.size());
  nodes_.emplace_back();
  build(0, order.data(), order.data() + order.size(), {Matrix3d::Identity(), Vector3d::Zero()});
}

void OrientedBoxTree::build(std::uint32_t node, std::uint32_t* begin, std::uint32_t* end, const Placed& parent)
{
  const Matrix3d axes = axesOf(covarianceOf(triangles_, begin, end));
  Eigen::AlignedBox3d box;  // in the frame of the axes
  Vector3d mean = Vector3d::Zero();
  for (const std::uint32_t* i = begin; i != end; ++i)
  {
    for (const Vector3d& corner : triangles_[*i])
      box.extend(axes.transpose() * corner);
    mean += axes.transpose() * centroid(triangles_[*i]);
  }
  mean /= static_cast<double>(end - begin);
  const Placed placed = {axes, axes * box.center()};
  nodes_[node].rotation = parent.rotation.transpose() * axes;
  nodes_[node].center = parent.rotation.transpose() * (placed.center - parent.center);
  nodes_[node].half = 0.5 * box.sizes();
  nodes_[node].triangle = *begin;
  if (end - begin == 1)
    return;

  std::array<int, 3> by_length = {0, 1, 2};
  std::sort(by_length.begin(), by_length.end(), [&](int i, int k) { return box.sizes()[i] > box.sizes()[k]; });
  std::uint32_t* middle = begin;
  for (std::size_t i = 0; i < 3 && (middle == begin || middle == end); ++i)
  {
    const Vector3d axis = axes.col(by_length[i]);
    middle = std::partition(begin, end,
                            [&](std::uint32_t t) { return axis.dot(centroid(triangles_[t])) < mean[by_length[i]]; });
  }
  if (middle == begin || middle == end)  // all centroids are equal
    middle = begin + (end - begin) / 2;
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].child = child;
  nodes_.resize(nodes_.size() + 2);
  build(child, begin, middle, placed);
  build(child + 1, middle, end, placed);
}

bool boxesApart(const Matrix3d& rotation, const Vector3d& translation, const Vector3d& half_a, const Vector3d& half_b,
                double epsilon)
{
  const Matrix3d& r = rotation;
  const Vector3d& t = translation;
  const Matrix3d absolute = r.cwiseAbs().array() + epsilon;
  for (int i = 0; i < 3; ++i)
    if (std::abs(t[i]) > half_a[i] + absolute.row(i).dot(half_b))
      return true;
  for (int k = 0; k < 3; ++k)
    if (std::abs(t.dot(r.col(k))) > half_b[k] + absolute.col(k).dot(half_a))
      return true;
  for (int i = 0; i < 3; ++i)
  {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int k = 0; k < 3; ++k)
    {
      const int k1 = (k + 1) % 3;
      const int k2 = (k + 2) % 3;
      // The axis is the product of a's axis i and b's axis k.
      const double reach = half_a[i1] * absolute(i2, k) + half_a[i2] * absolute(i1, k) + half_b[k1] * absolute(i, k2) +
                           half_b[k2] * absolute(i, k1);
      if (std::abs(t[i2] * r(i1, k) - t[i1] * r(i2, k)) > reach)
        return true;
    }
  }
  return false;
}

OrientedBoxTreePtr orientedBoxTree(const MeshPtr& mesh)
{
  return sharedTree<OrientedBoxTree>(mesh);
}

std::unique_ptr<Method> makeOrientedBoxes(const MeshPtr& a, const MeshPtr& b, double epsilon, Search search)
{
  return std::make_unique<OrientedBoxes>(orientedBoxTree(a), orientedBoxTree(b), epsilon, search);
}
}  // namespace gpu_planning_scene::core::literature
