#include <ccd/ccd.h>
#include <ccd/vec3.h>

#include "gpu_planning_scene/error.h"
#include "literature/convex/hull_tree.h"
#include "literature/method.h"

// S. A. Ehmann, M. C. Lin: Accurate and fast proximity queries between polyhedra using convex surface decomposition,
// 2001.
//
// Idea: the surface is divided into patches, each of which lies on its own convex hull. Two surfaces collide if two
// of these hulls collide. A binary tree of hulls over the patches leads to the hulls that may collide. Pairs of hulls
// are tested by the algorithm of Gilbert, Johnson and Keerthi (1988) as implemented by libccd, in place of the
// paper's Lin-Canny.
//
// Domain: closed 2-manifolds. The hull of a patch is then a part of the solid.
//
// Failures: at saddles and at the edges of holes, the patches are small, and the tree may have as many leaves as one
// over triangles. Where a mesh is open, the hull of a patch is no part of a solid, so there are false hits. A shape
// deep inside another one touches no hull, so containment is missed, unless the outer shape is one patch. The epsilon
// of libccd, 1e-10, is absolute, so shapes of a micrometre collide too early.
namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr std::size_t kMostTriangles = 100000;

/// A hull that is placed in the frame of a.
struct PlacedHull
{
  const HullTree::Node* node;
  const Eigen::Isometry3d* pose;
};

void farthest(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point)
{
  const auto& hull = *static_cast<const PlacedHull*>(object);
  const Eigen::Vector3d along =
      hull.pose->linear().transpose() * Eigen::Vector3d(direction->v[0], direction->v[1], direction->v[2]);
  const Eigen::Vector3d* best = &hull.node->vertices[0];
  double most = best->dot(along);
  for (const Eigen::Vector3d& vertex : hull.node->vertices)
    if (const double reach = vertex.dot(along); reach > most)
    {
      most = reach;
      best = &vertex;
    }
  const Eigen::Vector3d placed = *hull.pose * *best;
  ccdVec3Set(point, placed.x(), placed.y(), placed.z());
}

class ConvexSurfaces : public Method
{
 public:
  ConvexSurfaces(const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b)
    : a_(prepared(*a)), b_(a == b ? a_ : prepared(*b))
  {
    CCD_INIT(&solver_);
    solver_.support1 = farthest;
    solver_.support2 = farthest;
    solver_.max_iterations = 200;
  }

  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) override
  {
    std::vector<std::uint8_t> answers;
    for (const Eigen::Isometry3d& pose : b_in_a)
      answers.push_back(collides(pose) ? 1 : 0);
    return answers;
  }

  WorkCounts work() const override
  {
    return {{"pieces of a", static_cast<double>(a_->patchCount())},
            {"pieces of b", static_cast<double>(b_->patchCount())},
            {"sphere tests", sphere_tests_},
            {"hull tests", hull_tests_}};
  }

 private:
  static std::shared_ptr<const HullTree> prepared(const Mesh& mesh)
  {
    if (mesh.triangles.size() > kMostTriangles)
      throw Error("the convex surface decomposition of " + std::to_string(mesh.triangles.size()) +
                  " triangles takes too long; use at most " + std::to_string(kMostTriangles));
    return std::make_shared<const HullTree>(mesh);
  }

  bool collides(const Eigen::Isometry3d& b_in_a)
  {
    const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
    pairs_.assign(1, {0, 0});
    while (!pairs_.empty())
    {
      const auto [i, k] = pairs_.back();
      pairs_.pop_back();
      const HullTree::Node& a = a_->nodes()[i];
      const HullTree::Node& b = b_->nodes()[k];
      if (!overlap(a, identity, b, b_in_a))
        continue;
      if (a.child == 0 && b.child == 0)
        return true;
      if (b.child == 0 || (a.child != 0 && a.radius > b.radius))
        pairs_.insert(pairs_.end(), {{a.child, k}, {a.child + 1, k}});
      else
        pairs_.insert(pairs_.end(), {{i, b.child}, {i, b.child + 1}});
    }
    return false;
  }

  bool overlap(const HullTree::Node& a, const Eigen::Isometry3d& pose_a, const HullTree::Node& b,
               const Eigen::Isometry3d& pose_b)
  {
    sphere_tests_ += 1.0;
    const Eigen::Vector3d between = pose_b * b.center - pose_a * a.center;
    if (between.norm() > (a.radius + b.radius) * (1.0 + 1e-12))
      return false;
    hull_tests_ += 1.0;
    const PlacedHull first{&a, &pose_a};
    const PlacedHull second{&b, &pose_b};
    return ccdGJKIntersect(&first, &second, &solver_) != 0;
  }

  std::shared_ptr<const HullTree> a_;
  std::shared_ptr<const HullTree> b_;
  ccd_t solver_;
  std::vector<std::array<std::uint32_t, 2>> pairs_;
  double sphere_tests_ = 0.0;
  double hull_tests_ = 0.0;
};
}  // namespace

std::vector<MethodInfo> convexMethods()
{
  Domain closed;
  closed.open = false;
  return {{"convex_patches", "Convex patches, GJK", "Ehmann, Lin 2001", "convex", closed,
           [](const std::shared_ptr<const Mesh>& a, const std::shared_ptr<const Mesh>& b)
           { return std::make_unique<ConvexSurfaces>(a, b); }}};
}
}  // namespace gpu_planning_scene::core::literature
