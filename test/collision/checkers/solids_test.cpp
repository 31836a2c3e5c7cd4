// Bodies inside meshes that real files damage: the same answers on the CPU and on the device, and the right ones.

#include <random>

#include <gtest/gtest.h>

#include "collision/proofs/shape_samples.h"
#include "collision/trees/cpu_tree.h"
#include "gpu_planning_scene/mesh_pair_checker.h"
#include "model/real_robots.h"
#include "support/damaged_mesh.h"
#include "support/inside.h"
#include "support/moving_shape.h"
#include "support/obstacles.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using MeshPointer = std::shared_ptr<const Mesh>;

/// Shapes that are small against the meshes of the tests.
std::vector<Shape> probes(double size)
{
  return {Sphere{0.5 * size}, Box{Vector3d::Constant(size)}, tessellate(Box{Vector3d::Constant(size)}).mesh};
}

TEST(Solids, HaveInsideWhatTheUndamagedMeshHasOnAllDevices)
{
  const std::vector<MeshPointer> meshes = {tessellate(Box{{1.0, 0.8, 1.2}}).mesh, torusMesh(1.0, 0.4),
                                           tessellate(Cylinder{0.4, 1.0}).mesh};
  std::mt19937_64 generator(kSeed);
  std::size_t inside = 0;
  std::size_t tried = 0;
  std::size_t checked = 0;
  for (int repetition = 0; repetition < repetitions(1, 100); ++repetition)
    for (const MeshPointer& mesh : meshes)
    {
      const std::shared_ptr<const CpuTree> whole = cpuTreeOf(Shape(mesh), tessellate(Shape(mesh)));
      for (const MeshDamage damage : allMeshDamages())
      {
        const MeshPointer broken = damaged(*mesh, damage, damage == MeshDamage::Deleted ? 0.02 : 0.3, generator);
        double largest_hole = 1e-3;
        for (const MeshPart& part : solidMeshOf(broken)->parts.other)
          largest_hole = std::max(largest_hole, part.largest_hole);
        Eigen::AlignedBox3d box;
        for (const Vector3d& vertex : mesh->vertices)
          box.extend(vertex);
        std::vector<Isometry3d> poses;
        std::vector<std::uint8_t> expected;
        constexpr double kSize = 0.02;
        while (poses.size() < 40)
        {
          const Vector3d point = box.sample();
          // Neither on the surface nor near a hole, whose filling is not the lost surface.
          if (distanceFromSurface(*whole, point) < kSize + largest_hole)
          {
            if (largest_hole > 0.1)
              break;
            continue;
          }
          poses.emplace_back(Eigen::Translation3d(point));
          expected.push_back(isInside(Shape(mesh), point) ? 1 : 0);
          inside += expected.back();
          ++tried;
        }
        if (poses.empty())
          continue;
        // Each kind of damage with one of the probes and one of the traversals, in turn.
        const Shape probe = probes(kSize)[checked % 3];
        const Traversal traversal = checked++ % 2 == 0 ? Traversal::WorkQueue : Traversal::BreadthFirst;
        const std::string what = mesh->name + ", " + nameOf(damage) + ", probe " + std::to_string(probe.index()) +
                                 ", seed " + std::to_string(kSeed);
        BatchCheckerOptions options;
        options.traversal = traversal;
        EXPECT_EQ(MeshPairChecker(broken, probe, options).collide(poses), expected) << what;
        MovingShape on_cpu(probe, {{Shape(broken)}});
        for (std::size_t i = 0; i < poses.size(); ++i)
          EXPECT_EQ(on_cpu.collides(poses[i]) ? 1 : 0, expected[i]) << what;
      }
    }
  EXPECT_GT(inside, tried / 10);
}

TEST(Solids, OfG1HaveRoomForACubeInSixteenLinks)
{
  SKIP_WITHOUT(g1());
  constexpr double kSize = 0.01;
  const MeshPointer cube = tessellate(Box{Vector3d::Constant(kSize)}).mesh;
  std::mt19937_64 generator(kSeed);
  constexpr std::size_t kLinks = 16;
  std::size_t links = 0;
  const std::shared_ptr<const RobotModel> robot = g1().load();
  for (const Link& link : robot->links())
    for (const PlacedShape& placed : link.shapes)
    {
      const auto* mesh = std::get_if<MeshPointer>(&placed.shape);
      if (!mesh || links == kLinks)
        continue;
      const std::shared_ptr<const CpuTree> tree = cpuTreeOf(placed.shape, tessellate(placed.shape));
      Eigen::AlignedBox3d box;
      for (const Vector3d& vertex : (*mesh)->vertices)
        box.extend(vertex);
      bool has_room = false;
      MovingShape moving(cube, {{placed.shape}});
      for (int i = 0; i < 1500 && !has_room; ++i)
      {
        const Vector3d point = box.sample();
        has_room = distanceFromSurface(*tree, point) > kSize && isInside(placed.shape, point);
        if (has_room)
          EXPECT_TRUE(moving.collides(Isometry3d(Eigen::Translation3d(point))))
              << link.name << " " << point.transpose();
      }
      links += has_room ? 1 : 0;
    }
  EXPECT_EQ(links, kLinks);
}
}  // namespace
}  // namespace gpu_planning_scene::core
