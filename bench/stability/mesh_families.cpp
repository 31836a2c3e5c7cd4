// Closed and open meshes: contacts of solids, containment, and surfaces that are not as they should be.

#include "stability/case.h"
#include "stability/placing.h"
#include "stability/shapes.h"

namespace gpu_planning_scene::stability
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d shifted(const Vector3d& by)
{
  return Isometry3d(Eigen::Translation3d(by));
}

Vector3d randomSize(Random& random)
{
  return {random.uniform(0.2, 1.0), random.uniform(0.2, 1.0), random.uniform(0.2, 1.0)};
}

/// One box on another.
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

Case solidsAnyhow(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr a = random.coin() ? randomTetrahedron(random) : boxMesh(randomSize(random));
  const MeshPtr b = randomTetrahedron(random);
  const Vector3d point_a = innerPoint(random, a);
  const Vector3d point_b = innerPoint(random, b);
  return placed(random, a, b, justApart(random, a, point_a, b, point_b, random.offset()));
}

/// A corner or an edge of one box on a face of another.
Case solidVertexOrEdge(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr a = boxMesh(randomSize(random));
  const MeshPtr b = boxMesh(randomSize(random));
  const Isometry3d turned = random.coin() ? Isometry3d(random.rotation())
                                          : Isometry3d(Eigen::AngleAxisd(random.uniform(0.1, 1.4), Vector3d::UnitX()));
  return placed(random, a, b, justApart(a, b, turned, Vector3d::UnitZ(), random.offset()));
}

MeshPtr randomClosed(Random& random)
{
  switch (random.below(3))
  {
    case 0:
      return randomTetrahedron(random);
    case 1:
      return boxMesh(randomSize(random));
    default:
      return bumpyBall(random, 4);
  }
}

/// A thing that is up to `size` large.
MeshPtr small(Random& random, double size)
{
  const MeshPtr mesh = random.below(4) == 0 ? randomTriangle(random) : randomClosed(random);
  return scaled(*mesh, size);
}

/// Something small in or near a large mesh.
Case inSolid(Random& random, const MeshPtr& outer)
{
  const double size = random.logUniform(1e-3, 0.2);
  const MeshPtr inner = small(random, size);
  Isometry3d pose(random.rotation());
  pose.translation() = random.below(4) == 0 ? random.inCube(0.6) : random.inCube(0.3 - size);
  return placed(random, outer, inner, pose);
}

Case closedInClosed(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  return inSolid(random, random.coin() ? boxMesh(Vector3d::Ones()) : bumpyBall(random, 4));
}

Case closedInOpen(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr closed = random.coin() ? boxMesh(Vector3d::Ones()) : bumpyBall(random, 4);
  return inSolid(random, without(*closed, random.below(100)));
}

MeshPtr hollow(Random& random)
{
  const double cavity = random.uniform(0.5, 0.9);
  return joined(*boxMesh(Vector3d::Ones()), *inverted(*boxMesh(Vector3d::Constant(cavity))));
}

Case inCavity(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  return inSolid(random, hollow(random));
}

/// Three parts far from each other, one of them in or near a solid.
Case oneComponentInside(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double size = random.logUniform(1e-3, 0.2);
  MeshPtr parts;
  for (int i = 0; i < 3; ++i)
  {
    const Vector3d place = i == 0 ? random.inCube(0.45) : (2.0 * random.direction()).eval();
    const MeshPtr part = moved(*small(random, size), shifted(place));
    parts = i == 0 ? part : random.coin() ? joined(*parts, *part) : joined(*part, *parts);
  }
  return placed(random, boxMesh(Vector3d::Ones()), parts, Isometry3d(random.rotation()));
}

Case invertedShell(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr outer = random.coin() ? boxMesh(Vector3d::Ones()) : bumpyBall(random, 4);
  return inSolid(random, inverted(*outer));
}

Case mirroredShell(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr outer = random.coin() ? hollow(random) : bumpyBall(random, 4);
  return inSolid(random, mirrored(*outer));
}

Case deepOverlap(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  Isometry3d pose(random.rotation());
  pose.translation() = random.inCube(0.2);
  const MeshPtr a = randomClosed(random);
  return placed(random, a, randomClosed(random), pose);
}

/// A slab of a metre under a mesh of triangles of ten micrometres, and the other way round.
Case mixedSizes(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr slab = boxMesh({1.0, 1.0, 0.1});
  const MeshPtr grain = scaled(*(random.coin() ? bumpyBall(random, 4) : randomTetrahedron(random)), 1e-5);
  Isometry3d start(random.rotation());
  start.translation() = Vector3d(random.uniform(-0.49, 0.49), random.uniform(-0.49, 0.49), 0.05);
  return placed(random, slab, grain, justApart(slab, grain, start, Vector3d::UnitZ(), random.offset()));
}

/// A ball with a crack, a flipped triangle, a duplicate one, or passing through itself.
MeshPtr damaged(Random& random)
{
  const MeshPtr ball = bumpyBall(random, 4);
  auto vertices = ball->vertices;
  auto triangles = ball->triangles;
  auto& some = triangles[random.below(static_cast<int>(triangles.size()))];
  switch (random.below(4))
  {
    case 0:  // its corner is another vertex, some 1e-9 ... 1e-3 m off
      vertices.push_back(vertices[some[0]] + random.logUniform(1e-9, 1e-3) * random.direction());
      some[0] = static_cast<std::uint32_t>(vertices.size() - 1);
      break;
    case 1:
      std::swap(some[0], some[1]);
      break;
    case 2:
    {
      const auto copy = some;
      triangles.push_back(copy);
      break;
    }
    default:
      vertices[some[0]] = -1.2 * vertices[some[0]];
      break;
  }
  return makeMesh(std::move(vertices), std::move(triangles));
}

Case damagedSurfaces(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr a = damaged(random);
  if (random.coin())
    return inSolid(random, a);
  const MeshPtr b = random.coin() ? damaged(random) : randomTetrahedron(random);
  const Vector3d point_a = innerPoint(random, a);
  const Vector3d point_b = innerPoint(random, b);
  return placed(random, a, b, justApart(random, a, point_a, b, point_b, random.offset()));
}

/// A box that a link carries, on a table of the world.
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
  made.known = std::max(0.0, offset);
  return made;
}
}  // namespace

std::vector<Family> meshFamilies()
{
  std::vector<Family> families = {
      {"solids: face on face", solidFaces, true, true},
      {"solids: vertex or edge on face", solidVertexOrEdge, true, true},
      {"solids: any contact", solidsAnyhow, true, true},
      {"solids: deep interpenetration", deepOverlap},
      {"in or near a closed mesh", closedInClosed},
      {"in or near an open mesh", closedInOpen},
      {"in or near a cavity", inCavity},
      {"one component inside, the rest outside", oneComponentInside},
      {"inverted shells", invertedShell},
      {"mirrored shells", mirroredShell},
      {"triangle sizes 1e5 : 1", mixedSizes},
      {"cracks, flipped, duplicate, self-crossing", damagedSurfaces},
      {"attached box on a table", attachedOnTable, true, true},
      {"gripper finger on a held box", fingerOnHeldBox, true, true},
  };
  return families;
}
}  // namespace gpu_planning_scene::stability
