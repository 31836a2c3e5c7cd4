#include "literature/trees/dop18.h"

#include <algorithm>

#include <Eigen/LU>

#include "literature/descent.h"
#include "literature/trees/tree_method.h"

// J. T. Klosowski, M. Held, J. S. B. Mitchell, H. Sowizral, K. Zikan, "Efficient Collision Detection Using Bounding
// Volume Hierarchies of k-DOPs" (1998), with k = 18, their best. Both trees are built once. The corners of each 18-DOP
// of the moving mesh are found once, too. A query turns the corners of each visited node and takes their extents as the
// node's new 18-DOP, aligned with the fixed mesh: a little too large (the paper's approximation method), but sound.
// Domain: any mesh, surfaces only.
namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kOutside = 1e-9;  // of the size of a DOP

/// Three planes that meet in a point. Plane 2 i is the upper side of slab i, plane 2 i + 1 its lower side.
struct ThreePlanes
{
  std::array<std::size_t, 3> planes;
  Matrix3d inverse;  ///< of the matrix with the axes of the planes as rows
};

std::vector<ThreePlanes> allThreePlanes()
{
  std::vector<ThreePlanes> all;
  for (std::size_t i = 0; i < 18; ++i)
    for (std::size_t k = i + 1; k < 18; ++k)
      for (std::size_t l = k + 1; l < 18; ++l)
      {
        Matrix3d rows;
        rows << axesOf18Dop()[i / 2].transpose(), axesOf18Dop()[k / 2].transpose(), axesOf18Dop()[l / 2].transpose();
        if (std::abs(rows.determinant()) > 0.5)  // it is an integer
          all.push_back({{i, k, l}, rows.inverse()});
      }
  return all;
}

Slabs<9> turned(const Vector3d* corners, std::size_t count, const Eigen::Isometry3d& pose)
{
  Slabs<9> slabs;
  for (std::size_t c = 0; c < count; ++c)
  {
    const Vector3d p = pose * corners[c];
    const std::array<double, 9> along = {p.x(),         p.y(),         p.z(),         p.x() + p.y(), p.x() + p.z(),
                                         p.y() + p.z(), p.x() - p.y(), p.x() - p.z(), p.y() - p.z()};
    for (std::size_t i = 0; i < 9; ++i)
    {
      slabs.lower[i] = c == 0 ? along[i] : std::min(slabs.lower[i], along[i]);
      slabs.upper[i] = c == 0 ? along[i] : std::max(slabs.upper[i], along[i]);
    }
  }
  return slabs;
}

double sizeOf(const Slabs<9>& slabs)
{
  return std::max({slabs.upper[0] - slabs.lower[0], slabs.upper[1] - slabs.lower[1], slabs.upper[2] - slabs.lower[2]});
}

/// The tree of a mesh that moves: each node has the corners of its DOP, or of its triangle.
class MovingTree : public DopTree<9>
{
 public:
  explicit MovingTree(const Mesh& mesh) : DopTree<9>(mesh, axesOf18Dop())
  {
    for (const Node& node : nodes())
    {
      first_corner_.push_back(corners_.size());
      if (node.child != 0)
      {
        const std::vector<Vector3d> corners = cornersOf(node.slabs);
        corners_.insert(corners_.end(), corners.begin(), corners.end());
      }
      else
        corners_.insert(corners_.end(), triangles()[node.triangle].begin(), triangles()[node.triangle].end());
    }
    first_corner_.push_back(corners_.size());
  }

  Slabs<9> placed(std::uint32_t node, const Eigen::Isometry3d& pose) const
  {
    return turned(&corners_[first_corner_[node]], first_corner_[node + 1] - first_corner_[node], pose);
  }

 private:
  std::vector<Vector3d> corners_;
  std::vector<std::size_t> first_corner_;  // of each node
};

using MovingTreePtr = std::shared_ptr<const MovingTree>;

class Dop18 : public TreeMethod
{
 public:
  Dop18(MovingTreePtr a, MovingTreePtr b, DopDescent descent)
    : TreeMethod(a->triangles(), b->triangles(), Search::First), a_(std::move(a)), b_(std::move(b)), descent_(descent)
  {
  }

  WorkCounts work() const override
  {
    WorkCounts counts = TreeMethod::work();
    counts.emplace_back("refitted volumes", refitted_);
    return counts;
  }

 private:
  bool traverse() override { return traverse(0, 0, refitted(0)); }

  Slabs<9> refitted(std::uint32_t b)
  {
    ++refitted_;
    return b_->placed(b, pose());
  }

  /// `slabs`: of node b, aligned with a.
  bool traverse(std::uint32_t a, std::uint32_t b, const Slabs<9>& slabs)
  {
    const MovingTree::Node& node_a = a_->nodes()[a];
    const MovingTree::Node& node_b = b_->nodes()[b];
    countVolumeTest();
    if (!node_a.slabs.overlaps(slabs))
      return false;
    if (node_a.child == 0 && node_b.child == 0)
      return testLeaves(node_a.triangle, node_b.triangle);
    const double size_b = descent_ == DopDescent::FixedFirst ? 0.0 : sizeOf(node_b.slabs);
    if (opensFirst(node_a.child == 0, node_b.child == 0, sizeOf(node_a.slabs), size_b))
      return traverse(node_a.child, b, slabs) || traverse(node_a.child + 1, b, slabs);
    return traverse(a, node_b.child, refitted(node_b.child)) ||
           traverse(a, node_b.child + 1, refitted(node_b.child + 1));
  }

  MovingTreePtr a_;
  MovingTreePtr b_;
  DopDescent descent_;
  double refitted_ = 0.0;
};
}  // namespace

std::vector<Vector3d> cornersOf(const Slabs<9>& slabs)
{
  static const std::vector<ThreePlanes> all = allThreePlanes();
  const double tolerance = kOutside * sizeOf(slabs);
  std::vector<Vector3d> corners;
  for (const ThreePlanes& three : all)
  {
    Vector3d offsets;
    for (int i = 0; i < 3; ++i)
      offsets[i] = three.planes[i] % 2 == 0 ? slabs.upper[three.planes[i] / 2] : slabs.lower[three.planes[i] / 2];
    const Vector3d corner = three.inverse * offsets;
    bool inside = true;
    for (std::size_t i = 0; inside && i < 9; ++i)
    {
      const double along = axesOf18Dop()[i].dot(corner);
      inside = slabs.lower[i] - tolerance <= along && along <= slabs.upper[i] + tolerance;
    }
    const auto same = [&](const Vector3d& other) { return (other - corner).cwiseAbs().maxCoeff() <= 4.0 * tolerance; };
    if (inside && std::none_of(corners.begin(), corners.end(), same))
      corners.push_back(corner);
  }
  return corners;
}

std::unique_ptr<Method> makeDop18(const MeshPtr& a, const MeshPtr& b, DopDescent descent)
{
  return std::make_unique<Dop18>(sharedTree<MovingTree>(a), sharedTree<MovingTree>(b), descent);
}
}  // namespace gpu_planning_scene::core::literature
