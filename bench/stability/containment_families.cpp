// Meshes in or near closed, open and hollow meshes, and defective surfaces.

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

/// A mesh with a size of about `size` metres.
MeshPtr small(Random& random, double size)
{
  const MeshPtr mesh = random.below(4) == 0 ? randomTriangle(random) : randomClosed(random);
  return scaled(*mesh, size);
}

/// A small mesh in or near a large mesh.
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

Case inCavity(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  return inSolid(random, hollowBox(random.uniform(0.5, 0.9)));
}

/// Three or 100 separate components, one of them in or near a solid.
Case oneComponentInside(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const double size = random.logUniform(1e-3, 0.2);
  MeshPtr parts;
  const int count = random.below(16) == 0 ? 100 : 3;
  for (int i = 0; i < count; ++i)
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
  const MeshPtr outer = random.coin() ? hollowBox(random.uniform(0.5, 0.9)) : bumpyBall(random, 4);
  return inSolid(random, mirrored(*outer));
}

/// A box whose walls can be touched from inside: closed, open, hollow or inside out. `wall`: distance of the walls from
/// the centre, metres.
struct Room
{
  MeshPtr mesh;
  double wall;
};

Room randomRoom(Random& random)
{
  switch (random.below(4))
  {
    case 0:
      return {boxMesh(Vector3d::Ones()), 0.5};
    case 1:
      return {without(*boxMesh(Vector3d::Ones()), 0), 0.5};
    case 2:
      return {hollowBox(0.75), 0.375};
    default:
      return {inverted(*boxMesh(Vector3d::Ones())), 0.5};
  }
}

/// A mesh inside a room: just apart from a wall, touching it, or slightly through it.
Case againstWall(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const Room room = randomRoom(random);
  const MeshPtr inner = small(random, random.logUniform(1e-3, 0.2));
  Isometry3d pose(random.rotation());
  double reach = -1.0;
  for (const Vector3d& vertex : inner->vertices)
    reach = std::max(reach, (pose * vertex).x());
  pose.translation() = Vector3d(room.wall - reach + random.offset(), random.uniform(-0.1, 0.1), 0.02);
  return placed(random, room.mesh, inner, pose);
}

/// Meshes whose vertices are aligned with edges and vertices of the outer mesh, so rays along an axis hit these edges
/// and vertices.
Case inLine(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const Room room = randomRoom(random);
  const auto step = [&] { return 0.125 * (random.below(7) - 3); };
  const MeshPtr inner = random.coin() ? boxMesh(Vector3d::Constant(0.0625))
                                      : makeMesh({{0, 0, 0}, {0.0625, 0, 0}, {0, 0.0625, 0}, {0, 0, 0.0625}},
                                                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  return placed(random, room.mesh, inner, shifted({step(), step(), step()}));
}

/// A required distance above 0, with a mesh in or near closed, open and hollow meshes.
Case paddedInside(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const Room room = randomRoom(random);
  const MeshPtr inner = small(random, random.logUniform(1e-3, 0.2));
  Isometry3d pose(random.rotation());
  pose.translation() = random.inCube(random.coin() ? 0.2 : 0.6);
  return withPadding(random, placed(random, room.mesh, inner, pose));
}

Case damagedSurfaces(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const MeshPtr a = damagedBall(random);
  if (random.coin())
    return inSolid(random, a);
  const MeshPtr b = random.coin() ? damagedBall(random) : randomTetrahedron(random);
  const Vector3d point_a = innerPoint(random, a);
  const Vector3d point_b = innerPoint(random, b);
  return placed(random, a, b, poseNearContact(random, a, point_a, b, point_b, random.offset()));
}

}  // namespace

std::vector<Family> containmentFamilies()
{
  return {
      {"in or near a closed mesh", closedInClosed},
      {"in or near an open mesh", closedInOpen},
      {"in or near a cavity", inCavity},
      {"one component inside, the rest outside", oneComponentInside},
      {"inverted shells", invertedShell},
      {"mirrored shells", mirroredShell},
      {"against a wall, from inside", againstWall},
      {"inside, in line with edges and vertices", inLine},
      {"padded, in or near a mesh", paddedInside, false},
      {"cracks, flipped, duplicate, self-crossing", damagedSurfaces},
  };
}
}  // namespace gpu_planning_scene::core::stability
