#include "moveit/pairs/exact_pair.h"

#include <algorithm>
#include <utility>

#include "collision/exact/pair_clearance.h"
#include "collision/geometry/cpu_box_pair.h"
#include "moveit/shapes/octree_leaves.h"

// The verdicts come from the project's exact tests. An octree is traversed from its root in each test, so a leaf that
// the octomap updater has just changed counts at once.
namespace gpu_planning_scene::detector
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Exceeds the rounding of boxes and poses.
constexpr double kBoxMargin = 1e-9;  // metres

/// The bounds of a solid in the frame of an octree, without padding.
AlignedBox3d boundsIn(const ShapeInstance& octree, const ShapeInstance& solid)
{
  return core::boundsOf(solid.shape->tree(), core::relativePose(*octree.pose, *solid.pose));
}

Leaf leafOf(const ShapeInstance& octree, const Vector3d& center, unsigned depth)
{
  return {octree.shape->leaf(depth), *octree.pose * Eigen::Translation3d(center)};
}

/// Calls visit(leaf) for the occupied leaves that collide with a solid, until it returns true.
template <class Visit>
bool visitColliding(const ShapeInstance& octree, const ShapeInstance& solid, double margin, PairScratch& scratch,
                    const Visit& visit)
{
  const double required = octree.padding + solid.padding + margin;
  const AlignedBox3d bounds = boundsIn(octree, solid);
  const AlignedBox3d near(bounds.min().array() - required - kBoxMargin, bounds.max().array() + required + kBoxMargin);
  return visitOccupiedLeaves(
      octree.shape->octree(), [&near](const AlignedBox3d& box) { return near.intersects(box); },
      [&](const Vector3d& center, unsigned depth)
      {
        const Leaf leaf = leafOf(octree, center, depth);
        return exactTest().collide(solid.shape->tree(), *solid.pose, leaf.shape->tree(), leaf.pose, required,
                                   scratch) &&
               visit(leaf);
      });
}

bool solidCollides(const ShapeInstance& solid, const ShapeInstance& other, double margin, PairScratch& scratch)
{
  const double required = solid.padding + other.padding + margin;
  switch (other.shape->kind())
  {
    case ShapeKind::Solid:
      return exactTest().collide(solid.shape->tree(), *solid.pose, other.shape->tree(), *other.pose, required, scratch);
    case ShapeKind::HalfSpace:
      return exactTest().collide(solid.shape->tree(), *solid.pose, placedHalfSpace(other), required, scratch);
    case ShapeKind::Octree:
      return visitColliding(other, solid, margin, scratch, [](const Leaf&) { return true; });
    case ShapeKind::Empty:
      return false;
    case ShapeKind::Faulty:
      break;
  }
  return true;
}

bool halfSpacesMeet(const ShapeInstance& a, const ShapeInstance& b, double margin)
{
  const core::PlacedHalfSpace first = placedHalfSpace(a);
  const core::PlacedHalfSpace second = placedHalfSpace(b);
  return first.normal != -second.normal ||
         -first.offset - second.offset <= a.padding + b.padding + margin + core::kSlack;
}
}  // namespace

const core::CpuShapePair& exactTest()
{
  static const core::CpuShapePair test(nullptr);
  return test;
}

core::PlacedHalfSpace placedHalfSpace(const ShapeInstance& instance)
{
  const core::HalfSpace placed = core::moved(instance.shape->halfSpace(), *instance.pose);
  return {placed.normal, placed.offset};
}

bool boxesOverlap(const ShapeInstance& a, const ShapeInstance& b)
{
  if (a.shape->kind() != ShapeKind::Solid || b.shape->kind() != ShapeKind::Solid)
    return true;
  return core::overlap(a.shape->tree().box, core::placed(b.shape->tree().box, core::relativePose(*a.pose, *b.pose)),
                       a.padding + b.padding + kBoxMargin);
}

bool collide(const ShapeInstance& a, const ShapeInstance& b, PairScratch& scratch, double margin)
{
  const ShapeKind kind_a = a.shape->kind();
  const ShapeKind kind_b = b.shape->kind();
  if (kind_a == ShapeKind::Empty || kind_b == ShapeKind::Empty)
    return false;
  if (kind_a == ShapeKind::Faulty || kind_b == ShapeKind::Faulty)
    return true;
  if (kind_a == ShapeKind::Solid)
    return solidCollides(a, b, margin, scratch);
  if (kind_b == ShapeKind::Solid)
    return solidCollides(b, a, margin, scratch);
  return kind_a == ShapeKind::Octree || kind_b == ShapeKind::Octree || halfSpacesMeet(a, b, margin);
}

std::vector<Leaf> collidingLeaves(const ShapeInstance& octree, const ShapeInstance& solid, std::size_t most,
                                  PairScratch& scratch)
{
  std::vector<Leaf> leaves;
  visitColliding(octree, solid, 0.0, scratch,
                 [&](const Leaf& leaf)
                 {
                   leaves.push_back(leaf);
                   return leaves.size() >= most;
                 });
  return leaves;
}

bool nearestLeaf(const ShapeInstance& octree, const ShapeInstance& solid, double& least, Leaf& leaf,
                 PairScratch& scratch)
{
  const double required = octree.padding + solid.padding;
  const AlignedBox3d bounds = boundsIn(octree, solid);
  std::vector<std::pair<double, std::pair<Vector3d, unsigned>>> candidates;
  visitOccupiedLeaves(
      octree.shape->octree(),
      [&](const AlignedBox3d& box) { return bounds.exteriorDistance(box) - required - kBoxMargin < least; },
      [&](const Vector3d& center, unsigned depth)
      {
        const double half = 0.5 * octree.shape->octree().getNodeSize(static_cast<int>(depth));
        const AlignedBox3d box(center.array() - half, center.array() + half);
        candidates.push_back({bounds.exteriorDistance(box) - required - kBoxMargin, {center, depth}});
        return false;
      });
  std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  bool is_found = false;
  for (const auto& [lower, place] : candidates)
  {
    if (lower >= least)
      break;
    const Leaf candidate = leafOf(octree, place.first, place.second);
    const double found = core::pairClearance(solid.shape->tree(), *solid.pose, candidate.shape->tree(), candidate.pose,
                                             required, least, scratch)
                             .clearance;
    if (found >= least)
      continue;
    least = found;
    leaf = candidate;
    is_found = true;
  }
  return is_found;
}

double clearance(const ShapeInstance& a, const ShapeInstance& b, double most, PairScratch& scratch)
{
  const ShapeKind kind_a = a.shape->kind();
  const ShapeKind kind_b = b.shape->kind();
  if (kind_a == ShapeKind::Solid && kind_b == ShapeKind::Solid)
    return core::pairClearance(a.shape->tree(), *a.pose, b.shape->tree(), *b.pose, a.padding + b.padding, most, scratch)
        .clearance;
  if (kind_a == ShapeKind::Octree || kind_b == ShapeKind::Octree)
  {
    Leaf leaf;
    nearestLeaf(kind_a == ShapeKind::Octree ? a : b, kind_a == ShapeKind::Octree ? b : a, most, leaf, scratch);
    return most;
  }
  const auto collides = [&](double margin) { return collide(a, b, scratch, margin); };
  return collides(most) ? core::bisectLeast(0.0, most, collides) : most;
}
}  // namespace gpu_planning_scene::detector
