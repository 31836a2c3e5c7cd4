#include "moveit/pairs/pair_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/trees/cpu_forest.h"

// The exact tests have decided that the instances collide, or how far they are from each other.
namespace gpu_planning_scene::detector
{
namespace
{
using core::ShapeContact;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Contacts of this many leaves of an octree are computed.
constexpr std::size_t kMaxLeaves = 256;

core::ContactShape contactShape(const CollisionShape& shape, const Isometry3d& pose)
{
  return {&shape.tree(), pose, shape.isConvex()};
}

std::vector<ShapeContact> contactsOfSolids(const CollisionShape& a, const Isometry3d& pose_a, const CollisionShape& b,
                                           const Isometry3d& pose_b, double required, std::size_t most,
                                           PairScratch& scratch)
{
  return core::contactsOf({{contactShape(a, pose_a), contactShape(b, pose_b), required}}, {0}, exactTest(), scratch,
                          most);
}

void turn(std::vector<ShapeContact>& contacts)
{
  for (ShapeContact& contact : contacts)
    contact.normal = -contact.normal;
}

/// The contacts of a solid `a` with anything.
std::vector<ShapeContact> contactsOfSolid(const ShapeInstance& a, const ShapeInstance& b, std::size_t most,
                                          PairScratch& scratch, bool& are_all)
{
  const double required = a.padding + b.padding;
  if (b.shape->kind() == ShapeKind::Solid)
  {
    std::vector<ShapeContact> contacts =
        contactsOfSolids(*a.shape, *a.pose, *b.shape, *b.pose, required, most, scratch);
    are_all = contacts.size() < core::kMaxOfPair;
    return contacts;
  }
  if (b.shape->kind() == ShapeKind::HalfSpace)
  {
    const core::PlacedHalfSpace half_space = placedHalfSpace(b);
    return {core::contactWithHalfSpace(contactShape(*a.shape, *a.pose), half_space, required)};
  }
  std::vector<ShapeContact> contacts;
  const std::vector<Leaf> leaves = collidingLeaves(b, a, kMaxLeaves, scratch);
  are_all = leaves.size() < kMaxLeaves;
  for (const Leaf& leaf : leaves)
  {
    const std::vector<ShapeContact> found =
        contactsOfSolids(*a.shape, *a.pose, *leaf.shape, leaf.pose, required, most, scratch);
    are_all = are_all && found.size() < core::kMaxOfPair;
    contacts.insert(contacts.end(), found.begin(), found.end());
  }
  return contacts;
}

/// A contact that only tells that the shape instances count as colliding.
ShapeContact contactWithoutDepth(const ShapeInstance& a, const ShapeInstance& b)
{
  for (const ShapeInstance* instance : {&a, &b})
    if (instance->bounds.min().allFinite())
      return {instance->bounds.center(), Vector3d::UnitZ(), 0.0};
  Vector3d place = Vector3d::Zero();
  if (a.pose->translation().allFinite())
    place = a.pose->translation();
  return {place, Vector3d::UnitZ(), 0.0};
}

bool isSolid(const ShapeInstance& instance)
{
  return instance.shape->kind() == ShapeKind::Solid;
}

bool isFaulty(const ShapeInstance& instance)
{
  return instance.shape->kind() == ShapeKind::Faulty;
}

/// The nearest points of the surfaces without padding, at `distance` from each other. `a` is a solid.
NearestPoints nearestPointsOfSolid(const ShapeInstance& a, const ShapeInstance& b, double distance,
                                   PairScratch& scratch)
{
  if (b.shape->kind() == ShapeKind::HalfSpace)
  {
    const core::PlacedHalfSpace half_space = placedHalfSpace(b);
    const Vector3d point = core::contactWithHalfSpace(contactShape(*a.shape, *a.pose), half_space, 0.0).point;
    return {point, point - (half_space.normal.dot(point) - half_space.offset) * half_space.normal};
  }
  const std::shared_ptr<const void> nobody;  // `b` owns its shape
  Leaf leaf{{nobody, b.shape}, *b.pose};
  if (b.shape->kind() == ShapeKind::Octree)
  {
    double least = distance - a.padding - b.padding + 1e-3;  // just above the clearance, which is known
    if (!nearestLeaf(b, a, least, leaf, scratch))
      return {a.bounds.center(), a.bounds.center()};
  }
  const auto [on_a, on_b] =
      core::nearestPointsOf(contactShape(*a.shape, *a.pose), contactShape(*leaf.shape, leaf.pose), distance);
  return {on_a, on_b};
}
}  // namespace

std::vector<ShapeContact> contactsOf(const ShapeInstance& a, const ShapeInstance& b, std::size_t max_contacts,
                                     PairScratch& scratch, bool* are_all)
{
  std::vector<ShapeContact> contacts;
  bool are_all_here = true;
  const std::size_t most = std::min(max_contacts, core::kMaxOfPair);
  if (isFaulty(a) || isFaulty(b) || (!isSolid(a) && !isSolid(b)))
  {
    contacts.push_back(contactWithoutDepth(a, b));
    are_all_here = false;
  }
  else if (isSolid(a))
    contacts = contactsOfSolid(a, b, most, scratch, are_all_here);
  else
  {
    contacts = contactsOfSolid(b, a, most, scratch, are_all_here);
    turn(contacts);
  }
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const ShapeContact& first, const ShapeContact& second) { return first.depth > second.depth; });
  if (contacts.size() > max_contacts)
    contacts.resize(max_contacts);
  if (are_all != nullptr)
    *are_all = are_all_here;
  return contacts;
}

NearestPoints nearestPointsOf(const ShapeInstance& a, const ShapeInstance& b, double clearance, PairScratch& scratch)
{
  if (!isSolid(a) && !isSolid(b))
    return {contactWithoutDepth(a, b).point, contactWithoutDepth(a, b).point};
  const double distance = clearance + a.padding + b.padding;
  NearestPoints points =
      isSolid(a) ? nearestPointsOfSolid(a, b, distance, scratch) : nearestPointsOfSolid(b, a, distance, scratch);
  if (!isSolid(a))
    std::swap(points.on_a, points.on_b);
  const Vector3d between = points.on_b - points.on_a;
  const double length = between.norm();
  if (length > 0.0)
  {
    points.on_a += a.padding / length * between;
    points.on_b -= b.padding / length * between;
  }
  return points;
}
}  // namespace gpu_planning_scene::detector
