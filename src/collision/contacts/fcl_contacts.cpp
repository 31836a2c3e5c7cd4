#include "collision/contacts/fcl_contacts.h"

#include <algorithm>
#include <array>
#include <cassert>  // FCL 0.7 uses assert without it
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "collision/exact/pair_clearance.h"
#include "collision/geometry/primitive_solid.h"

// FCL computes contact points and nearest points. Its results are used only if they agree with the exact test;
// otherwise a search along the line between the centres gives the depth.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Tolerance for points on the border of a box.
constexpr double kContactMargin = 1e-6;  // metres

bool isUnit(const Vector3d& vector)
{
  return std::abs(vector.norm() - 1.0) < 1e-6;
}

/// The contacts that FCL finds between crossing surfaces; none if FCL fails with an exception.
///
/// For coplanar triangles and for triangles larger than the overlap, FCL may report points outside both shapes, and the
/// depth of a triangle. So points must lie in the boxes of both shapes. A translation along an axis that separates the
/// boxes also separates the shapes, so the shortest such translation limits the depth. Deeper contacts are reported
/// only if there are no others. They then get this limit as their depth.
std::vector<ShapeContact> fclContacts(const FclShape& a, const FclShape& b, const AlignedBox3d& box_a,
                                      const AlignedBox3d& box_b, double required, std::size_t max_contacts)
{
  const AlignedBox3d overlap = box_a.intersection(box_b);
  fcl::CollisionResultd result;
  try
  {
    fcl::collide(a.model.get(), a.pose, b.model.get(), b.pose, fcl::CollisionRequestd(max_contacts, true), result);
  }
  catch (const std::exception&)
  {
    return {};
  }
  const AlignedBox3d grown(overlap.min().array() - kContactMargin, overlap.max().array() + kContactMargin);
  const Vector3d translations = (box_a.max() - box_b.min()).cwiseMin(box_b.max() - box_a.min());
  const double deepest = std::max(0.0, translations.minCoeff());
  std::vector<ShapeContact> contacts;
  std::vector<ShapeContact> too_deep;
  for (std::size_t i = 0; i < result.numContacts(); ++i)
  {
    const fcl::Contactd& contact = result.getContact(i);
    if (!contact.pos.allFinite() || !grown.contains(contact.pos) || !isUnit(contact.normal) ||
        !std::isfinite(contact.penetration_depth))
      continue;
    // FCL may exchange a primitive and a tree; contact.o1 tells which shape is first.
    const Vector3d normal = contact.o1 == a.model.get() ? contact.normal : Vector3d(-contact.normal);
    const double depth = std::abs(contact.penetration_depth);
    (depth <= deepest + kContactMargin ? contacts : too_deep)
        .push_back({contact.pos, normal, required + std::min(depth, deepest)});
  }
  return contacts.empty() ? too_deep : contacts;
}

/// The direction from the centre of box a to the centre of box b; an arbitrary one if the centres coincide.
Vector3d directionBetween(const AlignedBox3d& a, const AlignedBox3d& b)
{
  const Vector3d translation = b.center() - a.center();
  return translation.norm() > 1e-9 ? Vector3d(translation.normalized()) : Vector3d::UnitZ();
}

/// The contact of two shapes that do not touch, but are within the required distance.
ShapeContact contactApart(const FclShape& a, const FclShape& b, const AlignedBox3d& box_a, const AlignedBox3d& box_b,
                          double distance, double required)
{
  const auto nearest = fclNearestPoints(a, b, distance);
  if (!nearest)
    return {0.5 * (box_a.center() + box_b.center()), directionBetween(box_a, box_b), required - distance};
  const Vector3d translation = (*nearest)[1] - (*nearest)[0];
  return {0.5 * ((*nearest)[0] + (*nearest)[1]),
          translation.norm() > 1e-9 ? Vector3d(translation.normalized()) : directionBetween(box_a, box_b),
          required - distance};
}

/// The contact of two shapes that touch, or of which one is inside the other.
ShapeContact contactWithin(const FclShape& a, const FclShape& b, const AlignedBox3d& box_a, const AlignedBox3d& box_b,
                           double required, const CpuShapePair& exact, CpuShapePair::Scratch& scratch)
{
  const Vector3d direction = directionBetween(box_a, box_b);
  const auto moved = [&](double translation)
  {
    FclShape shape = b;
    shape.pose.pretranslate(translation * direction);
    return shape;
  };
  const auto apart = [&](double translation)
  { return !exact.collide(a.tree, a.pose, b.tree, moved(translation).pose, 0.0, scratch); };
  // After this translation, the spheres around the two boxes do not overlap.
  const double depth = bisectLeast(0.0, box_a.diagonal().norm() + box_b.diagonal().norm(), apart);
  Vector3d point = box_a.intersection(box_b).center();  // one inside the other: centre of the inner box
  if (depth < kNearEnough)
    if (const auto nearest = fclNearestPoints(a, moved(depth + kNearEnough), kNearEnough))
      point = (*nearest)[0];
  return {point, direction, required + depth};
}
}  // namespace

std::optional<std::array<Vector3d, 2>> fclNearestPoints(const FclShape& a, const FclShape& b, double distance,
                                                        double tolerance)
{
  fcl::DistanceResultd result;
  try
  {
    fcl::distance(a.model.get(), a.pose, b.model.get(), b.pose, fcl::DistanceRequestd(true), result);
  }
  catch (const std::exception&)
  {
    return std::nullopt;
  }
  const bool exchanged = result.o1 != a.model.get();
  const Vector3d& p = result.nearest_points[exchanged ? 1 : 0];
  const Vector3d& q = result.nearest_points[exchanged ? 0 : 1];
  if (!p.allFinite() || !q.allFinite() || std::abs((q - p).norm() - distance) > tolerance)
    return std::nullopt;
  return std::array<Vector3d, 2>{p, q};
}

std::vector<ShapeContact> contactsOf(const FclShape& a, const FclShape& b, double required, const CpuForest& forest,
                                     const CpuShapePair& exact, CpuShapePair::Scratch& scratch,
                                     std::size_t max_contacts)
{
  const auto collides = [&](double distance)
  { return exact.collide(a.tree, a.pose, b.tree, b.pose, distance, scratch); };
  const AlignedBox3d box_a = boundsOf(forest.tree(a.tree), a.pose);
  const AlignedBox3d box_b = boundsOf(forest.tree(b.tree), b.pose);
  if (required > 0.0 && !collides(0.0))
    return {contactApart(a, b, box_a, box_b, bisectLeast(0.0, required, collides), required)};
  std::vector<ShapeContact> contacts = fclContacts(a, b, box_a, box_b, required, max_contacts);
  if (contacts.empty())
    contacts.push_back(contactWithin(a, b, box_a, box_b, required, exact, scratch));
  return contacts;
}

ShapeContact contactOf(const Isometry3d& pose, const Shape& shape, const WorldHalfSpace& half_space, double required)
{
  const Vector3d down = pose.linear().transpose() * -half_space.normal;
  Vector3d lowest = Vector3d::Zero();
  if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape))
  {
    const std::vector<Vector3d>& vertices = (*mesh)->vertices;
    lowest = *std::max_element(vertices.begin(), vertices.end(),
                               [&down](const Vector3d& a, const Vector3d& b) { return down.dot(a) < down.dot(b); });
  }
  else
    lowest = farthestOfSolid(shape, down);
  const Vector3d point = pose * lowest;
  return {point, -half_space.normal, half_space.offset + required - half_space.normal.dot(point)};
}
}  // namespace gpu_planning_scene::core
