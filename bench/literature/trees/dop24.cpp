#include "literature/trees/dop24.h"

#include <limits>

#include <Eigen/LU>

#include "literature/descent.h"
#include "literature/trees/tree_method.h"

// G. Zachmann, "Rapid Collision Detection by Dynamically Aligned DOP-Trees" (1998), with k = 24, the best in the paper.
// A DOP of the moving mesh is enclosed in a DOP that is aligned with the fixed mesh. Each new plane is a combination of
// three old ones: d'_i = c_i . (d_a, d_b, d_c) + o_i. The planes a, b and c are those whose normals enclose direction
// i. They depend only on the rotation, so they are found once a query. With weights c_i of at least 0, the new plane
// encloses the old DOP, whatever its extents. The trees are built as for the 18-DOP, because the comparison is one of
// volumes. (The paper has a construction of its own.) Both trees are descended at once. Domain: any mesh, surfaces
// only.
namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d normalOf(std::size_t plane)
{
  return plane % 2 == 0 ? axesOf24Dop()[plane / 2] : Vector3d(-axesOf24Dop()[plane / 2]);
}

/// Three normals such that no other normal lies in the cone between them.
struct Cone
{
  std::array<std::uint8_t, 3> planes;
  Matrix3d inverse;  ///< of the matrix with the normals as columns
};

/// The faces of the convex hull of all normals, cut into triangles. A face with more corners is covered more than once.
std::vector<Cone> allCones()
{
  constexpr double kSame = 1e-9;
  std::vector<Cone> cones;
  for (std::uint8_t i = 0; i < 24; ++i)
    for (std::uint8_t k = i + 1; k < 24; ++k)
      for (std::uint8_t l = k + 1; l < 24; ++l)
      {
        Matrix3d normals;
        normals << normalOf(i), normalOf(k), normalOf(l);
        if (std::abs(normals.determinant()) < kSame)
          continue;
        const Vector3d face = normals.transpose().inverse() * Vector3d::Ones();
        bool empty = true;
        for (std::size_t m = 0; empty && m < 24; ++m)
          empty = face.dot(normalOf(m)) < 1.0 + kSame;
        if (empty)
          cones.push_back({{i, k, l}, normals.inverse()});
      }
  return cones;
}

class Tree : public DopTree<12>
{
 public:
  explicit Tree(const Mesh& mesh) : DopTree<12>(mesh, axesOf24Dop()) {}
};

using TreePtr = std::shared_ptr<const Tree>;

class Dop24 : public TreeMethod
{
 public:
  Dop24(TreePtr a, TreePtr b)
    : TreeMethod(a->triangles(), b->triangles(), Search::First), a_(std::move(a)), b_(std::move(b))
  {
  }

  WorkCounts work() const override
  {
    WorkCounts counts = TreeMethod::work();
    counts.emplace_back("refitted volumes", realigned_);
    return counts;
  }

 private:
  bool traverse() override
  {
    const Realignment aligned(pose());
    return traverse(0, 0, aligned(b_->nodes().front().slabs), aligned);
  }

  /// `slabs`: of node b, aligned with a.
  bool traverse(std::uint32_t a, std::uint32_t b, const Slabs<12>& slabs, const Realignment& aligned)
  {
    const Tree::Node& node_a = a_->nodes()[a];
    const Tree::Node& node_b = b_->nodes()[b];
    countVolumeTest();
    if (!node_a.slabs.overlaps(slabs))
      return false;
    if (node_a.child == 0 && node_b.child == 0)
      return testLeaves(node_a.triangle, node_b.triangle);
    const Children of_a = childrenOrSelf(a_->nodes(), a);
    const Children of_b = childrenOrSelf(b_->nodes(), b);
    for (std::uint32_t i = 0; i < of_b.count; ++i)
    {
      realigned_ += node_b.child == 0 ? 0 : 1;
      const Slabs<12> smaller = node_b.child == 0 ? slabs : aligned(b_->nodes()[of_b.first + i].slabs);
      for (std::uint32_t k = 0; k < of_a.count; ++k)
        if (traverse(of_a.first + k, of_b.first + i, smaller, aligned))
          return true;
    }
    return false;
  }

  TreePtr a_;
  TreePtr b_;
  double realigned_ = 0.0;
};
}  // namespace

Realignment::Realignment(const Eigen::Isometry3d& b_in_a)
{
  static const std::vector<Cone> cones = allCones();
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const Vector3d direction = b_in_a.linear().transpose() * axesOf24Dop()[i];
    double best = -std::numeric_limits<double>::infinity();
    for (const Cone& cone : cones)
    {
      const Vector3d weights = cone.inverse * direction;
      if (weights.minCoeff() <= best)
        continue;
      best = weights.minCoeff();
      rows_[i].planes = cone.planes;
      rows_[i].weights = {weights.x(), weights.y(), weights.z()};
    }
    rows_[i].shift = axesOf24Dop()[i].dot(b_in_a.translation());
  }
}

Slabs<12> Realignment::operator()(const Slabs<12>& slabs) const
{
  Slabs<12> aligned;
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const Row& row = rows_[i];
    double upper = 0.0;
    double lower = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::size_t slab = row.planes[k] / 2;
      const bool up = row.planes[k] % 2 == 0;
      // The extents along the opposite normals bound the opposite direction.
      upper += row.weights[k] * (up ? slabs.upper[slab] : -slabs.lower[slab]);
      lower += row.weights[k] * (up ? slabs.lower[slab] : -slabs.upper[slab]);
    }
    aligned.upper[i] = row.shift + upper;
    aligned.lower[i] = row.shift + lower;
  }
  return aligned;
}

std::unique_ptr<Method> makeDop24(const MeshPtr& a, const MeshPtr& b)
{
  return std::make_unique<Dop24>(sharedTree<Tree>(a), sharedTree<Tree>(b));
}
}  // namespace gpu_planning_scene::core::literature
