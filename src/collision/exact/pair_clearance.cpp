#include "collision/exact/pair_clearance.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "collision/geometry/cpu_box_pair.h"
#include "collision/geometry/primitive_solid.h"

// Branch and bound over the trees (Larsen, Gottschalk, Lin and Manocha, "Fast Distance Queries with Rectangular Swept
// Sphere Volumes", 2000): the nearer nodes come first. A pair of nodes is skipped if it cannot be nearer than the best
// pair of leaves so far. The leaves are decided by the exact tests of the collision query, so the distance is as exact
// as its verdicts.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Distance bounds are widened by this margin, which exceeds their rounding error and kSlack.
constexpr double kMargin = 1e-9;  // metres

/// The clearance found so far, and the parts that have it. For two parts, within(v) of update() tells whether they are
/// within the distance v, and distance() is an estimate of their distance.
class Best
{
 public:
  Best(double required, double most) : required_(required), most_(most), clearance_(most) {}

  PairClearance found() const { return {clearance_, clearance_ < most_ ? parts_ : std::nullopt}; }
  /// Nodes that are farther from each other than this cannot improve the clearance or the parts.
  double reach() const { return required_ + clearance_ + kResolution + kMargin; }

  /// Returns whether the clearance became less. Bisection leaves it up to kResolution below the truth, so parts that
  /// are nearer than the known ones may be above it.
  template <class Within, class Distance>
  bool update(const ShapeParts& parts, const Within& within, const Distance& distance)
  {
    const auto meets = [&](double x) { return within(required_ + x); };
    if (!meets(clearance_ + kResolution))
      return false;
    const double found = distance();
    if (!parts_ || found < distance_)
    {
      parts_ = parts;
      distance_ = found;
    }
    if (!meets(clearance_))
      return false;
    clearance_ = bisectLeast(0.0, clearance_, meets, found - required_);
    return true;
  }

 private:
  double required_;
  double most_;
  double clearance_;
  double distance_ = 0.0;  // of the parts
  std::optional<ShapeParts> parts_;
};

/// A stack of box pairs. The boxes below a node are pushed together, and the nearest of them is popped first.
class NearestFirst
{
 public:
  explicit NearestFirst(std::vector<CpuShapePair::NearBoxes>& stack) : stack_(stack)
  {
    stack_.assign(1, {0.0, WideTree::kRoot, WideTree::kRoot});
  }

  bool empty() const { return stack_.empty(); }
  CpuShapePair::NearBoxes pop()
  {
    const CpuShapePair::NearBoxes top = stack_.back();
    stack_.pop_back();
    return top;
  }
  void beginNode() { first_ = stack_.size(); }
  void push(const CpuShapePair::NearBoxes& boxes)
  {
    stack_.push_back(boxes);
    for (std::size_t i = stack_.size() - 1; i > first_ && stack_[i - 1].least < boxes.least; --i)
      std::swap(stack_[i - 1], stack_[i]);
  }

 private:
  std::vector<CpuShapePair::NearBoxes>& stack_;
  std::size_t first_ = 0;  // of the boxes of the current node
};

/// The search in two meshes.
class SurfaceSearch
{
 public:
  /// Both poses in the frame of `a`.
  SurfaceSearch(const CpuTree& a, const CpuTree& b, const Isometry3d& b_in_a, Best& best)
    : a_(a),
      b_(b),
      b_in_a_(b_in_a),
      a_in_b_(b_in_a.inverse()),
      best_(best),
      tests_(availableWideTests().front()),
      in_a_(b.wide, b_in_a_, a.wide, best.reach()),
      in_b_(a.wide, a_in_b_, b.wide, best.reach())
  {
  }

  void run(CpuShapePair::Scratch& scratch)
  {
    NearestFirst stack(scratch.near_boxes);
    while (!stack.empty())
    {
      const CpuShapePair::NearBoxes boxes = stack.pop();
      if (boxes.least > best_.reach())
        continue;
      if (a_.wide.isLeaf(boxes.a) && b_.wide.isLeaf(boxes.b))
        compareLeaves(boxes.a, boxes.b);
      else
        open(boxes, stack, scratch.steps);
    }
  }

 private:
  void open(const CpuShapePair::NearBoxes& boxes, NearestFirst& stack, std::uint64_t& steps) const
  {
    const bool open_a = opensFirst(a_.wide, boxes.a, b_.wide, boxes.b);
    const WideTree& opened = open_a ? a_.wide : b_.wide;
    const BoxIndex box = open_a ? boxes.a : boxes.b;
    const FloatBox other = open_a ? in_a_.place(b_.wide, boxes.b) : in_b_.place(a_.wide, boxes.a);
    steps += CpuShapePair::Scratch::kStepsOfEightBoxes;
    stack.beginNode();
    for (unsigned hits = tests_.overlap(opened.below(box), other); hits != 0; hits &= hits - 1)
    {
      const BoxIndex child = opened.child(box, lowestBit(hits));
      const BoxIndex in_a = open_a ? child : boxes.a;
      const BoxIndex in_b = open_a ? boxes.b : child;
      stack.push({leastDistance(in_a, in_b), in_a, in_b});
    }
  }

  /// Lower bound of the distance of the triangles in two boxes.
  double leastDistance(BoxIndex in_a, BoxIndex in_b) const
  {
    return (a_.wide.center(in_a) - b_in_a_ * b_.wide.center(in_b)).norm() - a_.wide.radius(in_a) -
           b_.wide.radius(in_b) - a_.wide.centerError() - b_.wide.centerError();
  }

  void compareLeaves(BoxIndex leaf_a, BoxIndex leaf_b)
  {
    const TriangleBlock& block_a = a_.wide.triangles(leaf_a);
    const TriangleBlock& block_b = b_.wide.triangles(leaf_b);
    bool is_nearer = false;
    for (unsigned near = tests_.near_triangles(block_a, in_a_.place(block_b), in_a_.distance()); near != 0;
         near &= near - 1)
    {
      const unsigned bit = lowestBit(near);
      const ShapeParts parts = {block_a.first + bit % kBlockTriangles, block_b.first + bit / kBlockTriangles};
      const Triangle& of_a = a_.triangles[parts.of_a];
      const Triangle& t = b_.triangles[parts.of_b];
      const Triangle of_b = {b_in_a_ * t[0], b_in_a_ * t[1], b_in_a_ * t[2]};
      is_nearer |= best_.update(
          parts, [&](double distance) { return trianglesWithin(of_a, of_b, distance); },
          [&] { return outlineDistance(of_a, of_b); });
    }
    if (!is_nearer)
      return;
    in_a_ = WidePlacement(b_.wide, b_in_a_, a_.wide, best_.reach());
    in_b_ = WidePlacement(a_.wide, a_in_b_, b_.wide, best_.reach());
  }

  const CpuTree& a_;
  const CpuTree& b_;
  Isometry3d b_in_a_;
  Isometry3d a_in_b_;
  Best& best_;
  WideTests tests_;
  WidePlacement in_a_;  // places boxes of b in the frame of a, grown by the best clearance so far
  WidePlacement in_b_;
};

void surfaceApartFromSolid(const CpuTree& mesh, const CpuTree& solid, const Isometry3d& mesh_in_solid, Best& best,
                           CpuShapePair::Scratch& scratch)
{
  const WideTree& tree = mesh.wide;
  const OrientedBox around = placed(solid.box, mesh_in_solid.inverse());
  const OverlapTest overlap_of_eight = availableWideTests().front().overlap;
  NearestFirst stack(scratch.near_boxes);
  while (!stack.empty())
  {
    const CpuShapePair::NearBoxes boxes = stack.pop();
    if (boxes.least > best.reach())
      continue;
    if (tree.isLeaf(boxes.a))
    {
      const CpuNode& node = mesh.nodes[tree.source(boxes.a)];
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      {
        const Triangle& t = mesh.triangles[i];
        const Triangle triangle = {mesh_in_solid * t[0], mesh_in_solid * t[1], mesh_in_solid * t[2]};
        best.update(
            {i, ShapeParts::kWhole},
            [&](double distance) { return triangleWithinSolid(triangle, solid.shape, distance); },
            [&] { return distanceToSolid(solid.shape, triangle); });
      }
      continue;
    }
    scratch.steps += CpuShapePair::Scratch::kStepsOfEightBoxes;
    stack.beginNode();
    const FloatBox around_in_floats = floatBox(around, tree, best.reach());
    for (unsigned hits = overlap_of_eight(tree.below(boxes.a), around_in_floats); hits != 0; hits &= hits - 1)
    {
      const BoxIndex child = tree.child(boxes.a, lowestBit(hits));
      const double least =
          distanceToSolid(solid.shape, mesh_in_solid * tree.center(child)) - tree.radius(child) - tree.centerError();
      stack.push({least, child, WideTree::kRoot});
    }
  }
}
}  // namespace

PairClearance pairClearance(const CpuTree& a, const Isometry3d& pose_a, const CpuTree& b, const Isometry3d& pose_b,
                            double required, double most, CpuShapePair::Scratch& scratch)
{
  Best best(required, most);
  const Isometry3d b_in_a = relativePose(pose_a, pose_b);
  if (a.mesh && b.mesh)
    SurfaceSearch(a, b, b_in_a, best).run(scratch);
  else if (a.mesh)
    surfaceApartFromSolid(a, b, b_in_a.inverse(), best, scratch);
  else if (b.mesh)
    surfaceApartFromSolid(b, a, b_in_a, best, scratch);
  else
    best.update(
        {ShapeParts::kWhole, ShapeParts::kWhole},
        [&](double distance) { return solidsWithin(a.shape, b.shape, b_in_a, distance); },
        [&] { return distanceOfSolids(a.shape, b.shape, b_in_a); });
  PairClearance found = best.found();
  if (found.parts && !a.mesh && b.mesh)
    std::swap(found.parts->of_a, found.parts->of_b);
  return found;
}
}  // namespace gpu_planning_scene::core
