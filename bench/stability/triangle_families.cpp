// Pairs of single triangles. They are surfaces without a solid.

#include "stability/case.h"
#include "stability/placing.h"
#include "stability/shapes.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d lifted(double x, double y, double z)
{
  return Isometry3d(Eigen::Translation3d(x, y, z));
}

/// A triangle in the plane z = 0, around the origin.
MeshPtr flatTriangle(Random& random)
{
  return triangleMesh({random.uniform(-0.6, -0.3), random.uniform(-0.6, -0.3), 0.0},
                      {random.uniform(0.4, 0.6), random.uniform(-0.6, -0.2), 0.0},
                      {random.uniform(-0.1, 0.1), random.uniform(0.4, 0.6), 0.0});
}

Case facesTouch(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double offset = random.offset();
  Case made = placed(random, flatTriangle(random), flatTriangle(random),
                     lifted(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), offset));
  made.known = std::abs(offset);
  return made;
}

Case vertexOnFace(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double offset = random.offset();
  const MeshPtr other = triangleMesh({random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0.0},
                                     {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.2, 1.0)},
                                     {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.2, 1.0)});
  Case made = placed(random, flatTriangle(random), other, lifted(0.0, 0.0, offset));
  made.known = std::max(0.0, offset);
  return made;
}

Case edgeOnFace(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double offset = random.offset();
  const MeshPtr other = triangleMesh({random.uniform(-1.0, -0.1), random.uniform(-0.1, 0.1), 0.0},
                                     {random.uniform(0.1, 1.0), random.uniform(-0.1, 0.1), 0.0},
                                     {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.2, 1.0)});
  Case made = placed(random, flatTriangle(random), other, lifted(0.0, 0.0, offset));
  made.known = std::max(0.0, offset);
  return made;
}

/// An edge along x whose triangle extends to negative y, and an edge along z at y = offset whose triangle extends to
/// positive y.
Case edgesCross(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double offset = random.offset();
  const MeshPtr first =
      triangleMesh({random.uniform(-1.0, -0.1), 0.0, 0.0}, {random.uniform(0.1, 1.0), 0.0, 0.0},
                   {random.uniform(-1.0, 1.0), random.uniform(-1.0, -0.3), random.uniform(-1.0, 1.0)});
  const MeshPtr second = triangleMesh({0.0, 0.0, random.uniform(-1.0, -0.1)}, {0.0, 0.0, random.uniform(0.1, 1.0)},
                                      {random.uniform(-1.0, 1.0), random.uniform(0.3, 1.0), random.uniform(-1.0, 1.0)});
  Case made = placed(random, first, second, lifted(0.0, offset, 0.0));
  if (offset >= 0.0)
    made.known = offset;
  return made;
}

/// A corner on a corner or on an edge. The rest of each triangle lies on its own side of y = 0.
Case vertexOnVertexOrEdge(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double offset = random.offset();
  const auto side = [&](double sign)
  { return Vector3d(random.uniform(-1.0, 1.0), sign * random.uniform(0.2, 1.0), random.uniform(-1.0, 1.0)); };
  const MeshPtr first = random.coin()
                            ? triangleMesh({0.0, 0.0, 0.0}, side(-1.0), side(-1.0))
                            : triangleMesh({-random.uniform(0.1, 1.0), 0.0, 0.0}, {0.5, 0.0, 0.0}, side(-1.0));
  Case made = placed(random, first, triangleMesh({0.0, 0.0, 0.0}, side(1.0), side(1.0)), lifted(0.0, offset, 0.0));
  if (offset >= 0.0)
    made.known = offset;
  return made;
}

/// Two meshes that nearly touch or just touch.
Case nearContact(Random& random, const MeshPtr& a, const MeshPtr& b, const Place& place = {})
{
  const Vector3d point_a = innerPoint(random, a);
  const Vector3d point_b = innerPoint(random, b);
  return placed(random, a, b, poseNearContact(random, a, point_a, b, point_b, random.offset()), place);
}

/// 72 copies of one pair in the same place: 6 orders of the corners of each triangle, and both argument orders.
constexpr std::size_t kOrders = 72;

Case vertexOrders(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index / kOrders);
  Case made = nearContact(random, randomTriangle(random), randomTriangle(random));
  const auto order = static_cast<int>(index % kOrders);
  made.link_a = made.link_a * made.a_in_link;
  made.a_in_link.setIdentity();
  made.a = reordered(*std::get<MeshPtr>(made.a), order % 6);
  made.b = reordered(*std::get<MeshPtr>(made.b), order / 6 % 6);
  if (order >= 36)
  {
    std::swap(made.a, made.b);
    std::swap(made.link_a, made.pose_b);
  }
  return made;
}

Case rigidMotions(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  return nearContact(random, randomTriangle(random), randomTriangle(random));
}

Case farFromRoot(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  return nearContact(random, randomTriangle(random), randomTriangle(random), {570.0, Vector3d::Zero()});
}

const Vector3d kFarAway(6e4, -7e4, 4e4);

Case farFromOrigin(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  return nearContact(random, randomTriangle(random), randomTriangle(random), {1.0, kFarAway});
}

Case scaledSizes(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double scale = random.logUniform(1e-4, 1e3);
  const MeshPtr a = scaled(*randomTriangle(random), scale);
  const MeshPtr b = scaled(*randomTriangle(random), scale);
  return nearContact(random, a, b, {0.3 * scale, Vector3d::Zero()});
}

Case oneSliver(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  return nearContact(random, sliver(random, random.logUniform(1e-7, 1e-3)), randomTriangle(random));
}

Case twoSlivers(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr a = sliver(random, random.logUniform(1e-7, 1e-3));
  return nearContact(random, a, sliver(random, random.logUniform(1e-7, 1e-3)));
}

/// A degenerate triangle: a segment (three corners on a line, or two equal corners) or a point.
MeshPtr withoutArea(Random& random)
{
  const Vector3d a = random.inCube(0.5);
  const Vector3d b = random.inCube(0.5);
  switch (random.below(3))
  {
    case 0:
      return triangleMesh(a, b, a);
    case 1:
      return triangleMesh(a, b, 0.5 * (a + b));
    default:
      return triangleMesh(a, a, a);
  }
}

Case zeroArea(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr a = withoutArea(random);
  return nearContact(random, a, random.below(4) == 0 ? withoutArea(random) : randomTriangle(random));
}

Case inOnePlane(std::uint64_t seed, std::size_t index, bool overlapping)
{
  Random random(seed, index);
  const MeshPtr a = flatTriangle(random);
  const MeshPtr b = flatTriangle(random);
  const Isometry3d turned(Eigen::AngleAxisd(random.uniform(-3.0, 3.0), Vector3d::UnitZ()));
  if (overlapping)
  {
    Case made = placed(random, a, b, lifted(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.0) * turned);
    return made;
  }
  const double angle = random.uniform(-3.0, 3.0);
  const Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
  return placed(random, a, b, poseNearContact(a, b, turned, direction, std::abs(random.offset())));
}

/// Two triangles whose planes form an angle of 1e-3 ... 1e-9 rad, crossing or just apart.
Case nearlyParallel(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double angle = random.uniform(-3.0, 3.0);
  const Isometry3d tilted = lifted(0.0, 0.0, 0.0) * Eigen::AngleAxisd(random.logUniform(1e-9, 1e-3),
                                                                      Vector3d(std::cos(angle), std::sin(angle), 0.0));
  const MeshPtr a = flatTriangle(random);
  const MeshPtr b = flatTriangle(random);
  return placed(random, a, b, poseNearContact(a, b, tilted, Vector3d::UnitZ(), random.offset()));
}

/// Two triangles that share an edge or a corner, at any angle. Both have the same pose, so rounding does not separate
/// them.
Case sharing(std::uint64_t seed, std::size_t index, bool edge)
{
  Random random(seed, index);
  const Vector3d p = random.inCube(0.5);
  const Vector3d q = random.inCube(0.5);
  const MeshPtr a = triangleMesh(p, q, random.inCube(0.5));
  const MeshPtr b =
      edge ? triangleMesh(q, p, random.inCube(0.5)) : triangleMesh(p, random.inCube(0.5), random.inCube(0.5));
  Case made = placed(random, a, b, Isometry3d::Identity());
  made.link_a = made.pose_b;
  made.a_in_link.setIdentity();
  made.known = 0.0;
  return made;
}
}  // namespace

std::vector<Family> triangleFamilies()
{
  std::vector<Family> families = {
      {"faces touching", facesTouch},
      {"vertex on face", vertexOnFace},
      {"edge on face", edgeOnFace},
      {"edge on edge", edgesCross},
      {"vertex on vertex or edge", vertexOnVertexOrEdge},
      {"random rigid motions", rigidMotions},
      {"up to 1e3 m from the root", farFromRoot},
      {"scaled 1e-4 to 1e3", scaledSizes},
      {"one sliver, 1e-3 to 1e-7", oneSliver},
      {"two slivers, 1e-3 to 1e-7", twoSlivers},
      {"segments and points", zeroArea},
      {"coplanar, overlapping", [](std::uint64_t seed, std::size_t index) { return inOnePlane(seed, index, true); }},
      {"coplanar, apart", [](std::uint64_t seed, std::size_t index) { return inOnePlane(seed, index, false); }},
      {"nearly parallel planes", nearlyParallel},
      {"sharing an edge", [](std::uint64_t seed, std::size_t index) { return sharing(seed, index, true); }},
      {"sharing a vertex", [](std::uint64_t seed, std::size_t index) { return sharing(seed, index, false); }},
  };
  Family orders{"36 vertex orders, both argument orders", vertexOrders};
  orders.copies = kOrders;
  families.push_back(orders);
  Family far{"robot and all 1e5 m from the origin", farFromOrigin};
  far.origin = kFarAway;
  families.push_back(far);
  return families;
}
}  // namespace gpu_planning_scene::core::stability
