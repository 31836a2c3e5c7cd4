#include "literature/convex/hull_method.h"

#include <array>

#include <ccd/ccd.h>
#include <ccd/vec3.h>

#include "literature/descent.h"

// A tree of hulls leads to the pairs of hulls that may collide. A pair is tested by the algorithm of Gilbert, Johnson
// and Keerthi (1988) as implemented by libccd, after a test of two enclosing spheres.
namespace gpu_planning_scene::core::literature
{
namespace
{
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

class HullMethod : public PosewiseMethod
{
 public:
  HullMethod(std::shared_ptr<const HullTree> a, std::shared_ptr<const HullTree> b) : a_(std::move(a)), b_(std::move(b))
  {
    CCD_INIT(&solver_);
    solver_.support1 = farthest;
    solver_.support2 = farthest;
    solver_.max_iterations = 200;
  }

  WorkCounts work() const override { return {{"sphere tests", sphere_tests_}, {"hull tests", hull_tests_}}; }

  WorkCounts built() const override
  {
    return {{"pieces of a", static_cast<double>(a_->pieceCount())},
            {"pieces of b", static_cast<double>(b_->pieceCount())}};
  }

 private:
  bool collides(const Eigen::Isometry3d& b_in_a) override
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
      if (opensFirst(a.child == 0, b.child == 0, a.radius, b.radius))
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

std::unique_ptr<Method> makeHullMethod(std::shared_ptr<const HullTree> a, std::shared_ptr<const HullTree> b)
{
  return std::make_unique<HullMethod>(std::move(a), std::move(b));
}
}  // namespace gpu_planning_scene::core::literature
