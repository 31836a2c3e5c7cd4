#include "literature/trees/dop24.h"

#include <limits>

#include <Eigen/LU>

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
using Tree = DopTree<12>;

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

class Dop24 : public Method
{
 public:
  Dop24(const Mesh& a, const Mesh& b) : a_(a, axesOf24Dop()), b_(b, axesOf24Dop()) {}

  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) override
  {
    std::vector<std::uint8_t> answers;
    for (const Eigen::Isometry3d& pose : b_in_a)
    {
      pose_ = pose;
      const Realignment aligned(pose);
      answers.push_back(collides(0, 0, aligned(b_.nodes().front().slabs), aligned) ? 1 : 0);
    }
    return answers;
  }

  WorkCounts work() const override
  {
    return {{"volume tests", volume_tests_}, {"triangle tests", triangle_tests_}, {"refitted volumes", realigned_}};
  }

 private:
  /// `slabs`: of node b, aligned with a.
  bool collides(std::uint32_t a, std::uint32_t b, const Slabs<12>& slabs, const Realignment& aligned)
  {
    const Tree::Node& node_a = a_.nodes()[a];
    const Tree::Node& node_b = b_.nodes()[b];
    ++volume_tests_;
    if (!node_a.slabs.overlaps(slabs))
      return false;
    if (node_a.child == 0 && node_b.child == 0)
    {
      ++triangle_tests_;
      return trianglesOverlap(a_.triangles()[node_a.triangle],
                              moved(b_.triangles()[node_b.triangle], pose_.linear(), pose_.translation()));
    }
    if (node_b.child == 0)
      return collides(node_a.child, b, slabs, aligned) || collides(node_a.child + 1, b, slabs, aligned);
    for (std::uint32_t child = node_b.child; child < node_b.child + 2; ++child)
    {
      ++realigned_;
      const Slabs<12> child_slabs = aligned(b_.nodes()[child].slabs);
      if (node_a.child == 0 ? collides(a, child, child_slabs, aligned)
                            : collides(node_a.child, child, child_slabs, aligned) ||
                                  collides(node_a.child + 1, child, child_slabs, aligned))
        return true;
    }
    return false;
  }

  Tree a_;
  Tree b_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  double volume_tests_ = 0.0;
  double triangle_tests_ = 0.0;
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

std::unique_ptr<Method> makeDop24(const Mesh& a, const Mesh& b)
{
  return std::make_unique<Dop24>(a, b);
}
}  // namespace gpu_planning_scene::core::literature
