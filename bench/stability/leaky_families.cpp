// Closed meshes with the damages of real files, and small shapes inside and outside. The oracle judges the undamaged
// mesh, so it does not depend on the way in which the package closes meshes.

#include <algorithm>
#include <set>

#include "collision/geometry/triangle_pair.h"
#include "gpu_planning_scene/solids.h"
#include "stability/case.h"
#include "stability/placing.h"
#include "stability/shapes.h"
#include "support/damaged_mesh.h"
#include "support/obstacles.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kNearSurface = 2e-3;  // times the size of the mesh: twice as far as corners are joined

struct Leaky
{
  MeshPtr whole;
  MeshPtr damaged;
  std::vector<AlignedBox3d> lost;  // of the missing triangles that share corners
};

MeshPtr randomBody(Random& random)
{
  switch (random.below(6))
  {
    case 0:
      return boxMesh(randomSize(random));
    case 1:
      return bumpyBall(random, 4 + random.below(8));
    case 2:
      return torusMesh(random.uniform(0.3, 0.5), random.uniform(0.05, 0.2));
    case 3:
      return tessellate(Cylinder{random.uniform(0.05, 0.5), random.uniform(0.2, 1.0)}).mesh;
    case 4:
      return tessellate(Cone{random.uniform(0.2, 0.5), random.uniform(0.2, 0.5)}).mesh;
    default:
      return randomTetrahedron(random);
  }
}

Triangle triangleOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners)
{
  return {mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]};
}

double areaOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners)
{
  const Triangle t = triangleOf(mesh, corners);
  return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
}

/// Takes triangles away, unless more than the documented share of the area would be missing.
void remove(Random& random, std::mt19937_64& generator, Leaky& body)
{
  const MeshPtr left = damaged(*body.whole, MeshDamage::Deleted, random.uniform(0.0, 0.08), generator);
  const std::set<std::array<std::uint32_t, 3>> kept(left->triangles.begin(), left->triangles.end());
  double lost_area = 0.0;
  double area = 0.0;
  std::vector<std::set<std::uint32_t>> groups;  // the corners of missing triangles
  for (const auto& t : body.whole->triangles)
  {
    (kept.count(t) != 0 ? area : lost_area) += areaOf(*body.whole, t);
    if (kept.count(t) != 0)
      continue;
    std::set<std::uint32_t> group(t.begin(), t.end());
    for (auto other = groups.begin(); other != groups.end();)
      if (std::any_of(t.begin(), t.end(), [&](std::uint32_t corner) { return other->count(corner) != 0; }))
      {
        group.insert(other->begin(), other->end());
        other = groups.erase(other);
      }
      else
        ++other;
    groups.push_back(std::move(group));
  }
  if (lost_area > 0.95 * kSmallHoles * area)
    return;
  body.damaged = left;
  for (const std::set<std::uint32_t>& group : groups)
  {
    AlignedBox3d& box = body.lost.emplace_back();
    for (const std::uint32_t corner : group)
      box.extend(body.whole->vertices[corner]);
  }
}

Leaky damagedBody(Random& random)
{
  std::mt19937_64 generator(static_cast<std::uint64_t>(random.below(1 << 30)));
  Leaky body;
  body.damaged = body.whole = randomBody(random);
  if (random.below(3) == 0)
    remove(random, generator, body);
  // In the order in which files get them: faults of the triangles, then copies of all, then another order.
  for (const MeshDamage damage : {MeshDamage::Cracked, MeshDamage::Split, MeshDamage::Shifted, MeshDamage::Flipped,
                                  MeshDamage::Doubled, MeshDamage::FrontAndBack, MeshDamage::Shuffled})
    if (random.below(3) == 0)
      body.damaged =
          damaged(*body.damaged, damage, random.uniform(0.0, damage == MeshDamage::Cracked ? 0.1 : 0.9), generator);
  if (random.below(4) == 0)
    body.damaged = inverted(*body.damaged);
  return body;
}

/// One damaged body, or two that overlap or are apart.
Leaky damagedBodies(Random& random)
{
  Leaky first = damagedBody(random);
  if (random.below(3) != 0)
    return first;
  const Leaky second = damagedBody(random);
  Eigen::Isometry3d pose(random.rotation());
  pose.translation() = random.inCube(0.6);
  first.whole = joined(*first.whole, *moved(*second.whole, pose));
  first.damaged = joined(*first.damaged, *moved(*second.damaged, pose));
  for (const AlignedBox3d& box : second.lost)
    first.lost.push_back(box.transformed(pose));
  return first;
}

double distanceFrom(const Mesh& mesh, const Vector3d& point)
{
  double least = std::numeric_limits<double>::max();
  for (const auto& t : mesh.triangles)
    least = std::min(least, (nearestPoint(triangleOf(mesh, t), point) - point).norm());
  return least;
}

/// A small shape that touches no surface, and is not where triangles are missing.
Case besideDamage(std::uint64_t seed, std::size_t index)
{
  Random random(seed, index);
  const Leaky body = damagedBodies(random);
  AlignedBox3d box;
  for (const Vector3d& vertex : body.whole->vertices)
    box.extend(vertex);
  const double near = kNearSurface * box.diagonal().norm();
  double size = random.logUniform(1e-3, 0.1);
  // Further and further away: missing triangles may be everywhere.
  for (double away = 0.0;; away += 0.005, size *= 0.9)
  {
    Eigen::Isometry3d pose(random.rotation());
    const double reach = away + (random.below(4) == 0 ? 0.6 : 0.45);
    pose.translation() = box.center() + 2.0 * box.sizes().cwiseProduct(random.inCube(reach / 2.0));
    const auto is_lost = [&](const AlignedBox3d& lost)
    { return lost.exteriorDistance(pose.translation()) < size + near; };
    if (std::any_of(body.lost.begin(), body.lost.end(), is_lost) ||
        distanceFrom(*body.whole, pose.translation()) < size + near)
      continue;
    const MeshPtr inner = scaled(*randomClosed(random), size);
    Case made = placed(random, body.damaged, inner, pose);
    const auto* a = std::get_if<MeshPtr>(&made.a);
    (a && *a == body.damaged ? made.true_a : made.true_b) = body.whole;
    return made;
  }
}
}  // namespace

std::vector<Family> leakyFamilies()
{
  return {{"leaky solids", besideDamage}};
}
}  // namespace gpu_planning_scene::core::stability
