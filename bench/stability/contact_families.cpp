// Closed meshes that touch or overlap, and attached objects.

#include "stability/case.h"
#include "stability/placing.h"
#include "stability/shapes.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d shifted(const Vector3d& by)
{
  return Isometry3d(Eigen::Translation3d(by));
}

/// One box on another box.
Case solidFaces(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const Vector3d lower = randomSize(random);
  const Vector3d upper = randomSize(random);
  const double offset = random.offset();
  Case made =
      placed(random, boxMesh(lower), boxMesh(upper),
             shifted({random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.5 * (lower.z() + upper.z()) + offset}));
  made.known = std::max(0.0, offset);
  return made;
}

Case solidsRandomContact(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr a = random.coin() ? randomTetrahedron(random) : boxMesh(randomSize(random));
  const MeshPtr b = randomTetrahedron(random);
  const Vector3d point_a = innerPoint(random, a);
  const Vector3d point_b = innerPoint(random, b);
  return placed(random, a, b, poseNearContact(random, a, point_a, b, point_b, random.offset()));
}

/// A corner or an edge of one box on a face of another.
Case solidVertexOrEdge(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr a = boxMesh(randomSize(random));
  const MeshPtr b = boxMesh(randomSize(random));
  const Isometry3d turned = random.coin() ? Isometry3d(random.rotation())
                                          : Isometry3d(Eigen::AngleAxisd(random.uniform(0.1, 1.4), Vector3d::UnitX()));
  return placed(random, a, b, poseNearContact(a, b, turned, Vector3d::UnitZ(), random.offset()));
}

Case deepOverlap(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  Isometry3d pose(random.rotation());
  pose.translation() = random.inCube(0.2);
  const MeshPtr a = randomClosed(random);
  return placed(random, a, randomClosed(random), pose);
}

/// A slab of one metre and a mesh of ten micrometres on it.
Case mixedSizes(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr slab = boxMesh({1.0, 1.0, 0.1});
  const MeshPtr grain = scaled(*(random.coin() ? bumpyBall(random, 4) : randomTetrahedron(random)), 1e-5);
  Isometry3d start(random.rotation());
  start.translation() = Vector3d(random.uniform(-0.49, 0.49), random.uniform(-0.49, 0.49), 0.05);
  return placed(random, slab, grain, poseNearContact(slab, grain, start, Vector3d::UnitZ(), random.offset()));
}

/// The vertices of both are 100 m from the origin of their frames.
Case farFromOwnOrigin(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr a = random.coin() ? randomTriangle(random) : randomTetrahedron(random);
  const MeshPtr b = random.coin() ? randomTriangle(random) : randomTetrahedron(random);
  const Vector3d from_a = 100.0 * random.direction();
  const Vector3d from_b = 100.0 * random.direction();
  const Vector3d point_a = innerPoint(random, a);
  const Vector3d point_b = innerPoint(random, b);
  const Isometry3d b_in_a = poseNearContact(random, a, point_a, b, point_b, random.offset());
  return placed(random, moved(*a, shifted(from_a)), moved(*b, shifted(from_b)),
                shifted(from_a) * b_in_a * shifted(-from_b));
}

/// An attached box on a table of the world.
Case attachedOnTable(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const Vector3d table = {1.0, 0.8, 0.04};
  const Vector3d size = randomSize(random) / 4.0;
  const bool meshes = random.coin();
  const double offset = random.offset();
  const Isometry3d pose_table = random.motion(1.0);
  Isometry3d on_table(Eigen::AngleAxisd(random.uniform(-3.0, 3.0), Vector3d::UnitZ()));
  on_table.translation() =
      Vector3d(random.uniform(-0.3, 0.3), random.uniform(-0.2, 0.2), 0.5 * (table.z() + size.z()) + offset);
  Case made;
  made.a = meshes ? Shape(boxMesh(size)) : Shape(Box{size});
  made.b = meshes ? Shape(boxMesh(table)) : Shape(Box{table});
  made.a_in_link = random.motion(0.2);
  made.link_a = pose_table * on_table * made.a_in_link.inverse();
  made.pose_b = pose_table;
  made.known = std::max(0.0, offset);
  return made;
}

/// A finger of a gripper on a box that another link of the robot holds.
Case fingerOnHeldBox(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const Vector3d finger = {0.01, 0.02, 0.05};
  const Vector3d held = {random.uniform(0.02, 0.08), 0.04, 0.06};
  const double offset = random.offset();
  Case made;
  made.self = true;
  made.a = random.coin() ? Shape(boxMesh(finger)) : Shape(Box{finger});
  made.b = random.coin() ? Shape(boxMesh(held)) : Shape(Box{held});
  made.a_in_link = random.motion(0.1);
  made.pose_b = random.motion(1.0);
  const double side = random.coin() ? 1.0 : -1.0;
  made.link_a = made.pose_b *
                shifted({side * (0.5 * (finger.x() + held.x()) + offset), random.uniform(-0.01, 0.01), 0.02}) *
                made.a_in_link.inverse();
  if (random.coin())  // padding must have no effect between two links
    made.padding_a = made.padding_b = 0.01;
  made.known = std::max(0.0, offset);
  return made;
}
}  // namespace

std::vector<Family> contactFamilies()
{
  return {
      {"solids: face on face", solidFaces, true, true},
      {"solids: vertex or edge on face", solidVertexOrEdge, true, true},
      {"solids: any contact", solidsRandomContact, true, true},
      {"solids: deep interpenetration", deepOverlap},
      {"triangle sizes 1e5 : 1", mixedSizes},
      {"vertices 100 m from their frame's origin", farFromOwnOrigin},
      {"attached box on a table", attachedOnTable, true, true},
      {"gripper finger on a held box", fingerOnHeldBox, true, true},
  };
}
}  // namespace gpu_planning_scene::core::stability
