// Which points a mesh has inside, by brute force over the triangles that count for the solid.

#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/solids.h"
#include "model/solids/contains.h"
#include "support/damaged_mesh.h"
#include "support/inside.h"
#include "support/obstacles.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;
using MeshPointer = std::shared_ptr<const Mesh>;

bool contains(const MeshPointer& mesh, const Vector3d& point)
{
  return contains(*solidMeshOf(mesh), point);
}

MeshPointer changed(const MeshPointer& mesh, const std::function<void(Mesh&)>& change)
{
  auto copy = std::make_shared<Mesh>(*mesh);
  change(*copy);
  return copy;
}

/// A cube with edges of 2 m around `center`, with vertices of its own.
MeshPointer cube(const Vector3d& center = Vector3d::Zero())
{
  return changed(
      tessellate(Box{{2.0, 2.0, 2.0}}).mesh,
      [&](Mesh& mesh)
      {
        for (Vector3d& vertex : mesh.vertices)
          vertex += center;
      });
}

MeshPointer together(const MeshPointer& a, const MeshPointer& b)
{
  return changed(
      a,
      [&b](Mesh& mesh)
      {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), b->vertices.begin(), b->vertices.end());
        for (const auto& t : b->triangles)
          mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      });
}

/// Expects a solid that has the centre of the cube, points near its corners, and nothing outside.
void expectCube(const MeshPointer& mesh, const std::string& what, PartKind kind = PartKind::Mended)
{
  EXPECT_GE(solidMeshOf(mesh)->parts.count(kind), 1U) << what;
  EXPECT_EQ(solidMeshOf(mesh)->parts.count(PartKind::Surface), 0U) << what;
  for (const Vector3d& corner : mesh->vertices)
  {
    EXPECT_TRUE(contains(mesh, 0.97 * corner + Vector3d(1e-3, 2e-3, 3e-3))) << what;
    EXPECT_FALSE(contains(mesh, 1.03 * corner + Vector3d(1e-3, 2e-3, 3e-3))) << what;
  }
  EXPECT_TRUE(contains(mesh, Vector3d(0.01, 0.02, 0.03))) << what;
}

TEST(SolidMesh, OfAClosedMeshIsTheMeshItself)
{
  const MeshPointer mesh = cube();
  const auto solid = solidMeshOf(mesh);
  EXPECT_EQ(solid->mesh, mesh);
  EXPECT_EQ(solid->parts.closed, 1U);
  EXPECT_TRUE(solid->parts.other.empty());
  EXPECT_TRUE(solid->isAllSolid());
  EXPECT_EQ(solidMeshOf(mesh), solid) << "made twice";
  expectCube(mesh, "closed", PartKind::Closed);
}

TEST(SolidMesh, DoesNotDependOnTheDirectionOfTriangles)
{
  for (std::size_t flipped = 0; flipped < 12; ++flipped)
    expectCube(changed(
                   cube(), [&](Mesh& mesh) { std::swap(mesh.triangles[flipped][0], mesh.triangles[flipped][2]); }),
               "triangle " + std::to_string(flipped));
  expectCube(changed(cube(),
                     [](Mesh& mesh)
                     {
                       for (std::size_t t : {0U, 3U, 4U, 7U, 11U})
                         std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
                     }),
             "five triangles");
}

TEST(SolidMesh, CountsTrianglesThatAreThereTwiceOnce)
{
  expectCube(changed(
                 cube(),
                 [](Mesh& mesh) {
                   mesh.triangles.push_back({0, 2, 1});
                 }),
             "one twice");
  expectCube(changed(
                 cube(),
                 [](Mesh& mesh) {
                   mesh.triangles.push_back({0, 1, 2});
                 }),
             "one from both sides");
  expectCube(changed(
                 cube(),
                 [](Mesh& mesh)
                 {
                   for (std::size_t t = 0; t < 12; ++t)
                     mesh.triangles.push_back(std::array<std::uint32_t, 3>(mesh.triangles[t]));
                 }),
             "all twice");
  expectCube(changed(cube(),
                     [](Mesh& mesh)
                     {
                       for (std::size_t t = 0; t < 12; ++t)
                         mesh.triangles.push_back({mesh.triangles[t][0], mesh.triangles[t][2], mesh.triangles[t][1]});
                     }),
             "all from both sides");
}

TEST(SolidMesh, MayHaveVolumesThatTouch)
{
  // The wall between the first two is there twice, and their triangles there are cut along different diagonals or the
  // same ones.
  for (const Vector3d& shift : {Vector3d(2, 0, 0), Vector3d(0, 2, 0), Vector3d(0, 0, 2), Vector3d(2, 2, 0),
                                Vector3d(0, 2, 2), Vector3d(2, 2, 2)})
    for (const bool is_flipped : {false, true})
    {
      MeshPointer both = together(cube(), cube(shift));
      if (is_flipped)
        both = changed(both,
                       [](Mesh& mesh)
                       {
                         for (std::size_t t = 12; t < 24; ++t)
                           std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
                       });
      const std::string what = "shift " + std::to_string(shift.x()) + " " + std::to_string(shift.y()) + " " +
                               std::to_string(shift.z()) + (is_flipped ? ", one inside out" : "");
      EXPECT_EQ(solidMeshOf(both)->parts.count(PartKind::Surface), 0U) << what;
      for (const Vector3d& offset : {Vector3d(0.01, 0.02, 0.03), Vector3d(0.9, 0.85, 0.8), Vector3d(-0.9, -0.85, -0.8)})
      {
        EXPECT_TRUE(contains(both, offset)) << what;
        EXPECT_TRUE(contains(both, shift + offset)) << what;
      }
      EXPECT_FALSE(contains(both, Vector3d(-1.1, 0.02, 0.03))) << what;
      EXPECT_FALSE(contains(both, shift + Vector3d(1.1, 0.02, 0.03))) << what;
    }
}

TEST(SolidMesh, ClosesSeamsWithTJunctions)
{
  std::mt19937_64 generator(kSeed);
  for (int repetition = 0; repetition < repetitions(8, 200); ++repetition)
    expectCube(damaged(*cube(), MeshDamage::Split, 0.5, generator), "split");
}

TEST(SolidMesh, JoinsCornersThatDifferByRounding)
{
  expectCube(changed(cube(),
                     [](Mesh& mesh)
                     {
                       mesh.vertices.push_back(mesh.vertices[0] + Vector3d(1e-9, -1e-9, 0.0));
                       mesh.triangles[0][0] = 8;
                     }),
             "one corner");
  std::mt19937_64 generator(kSeed);
  for (int repetition = 0; repetition < repetitions(8, 200); ++repetition)
    expectCube(damaged(*cube(), MeshDamage::Shifted, 1.0, generator), "all corners");
}

TEST(SolidMesh, KeepsItsVolumeWithAFin)
{
  struct Fin
  {
    std::uint32_t a;
    std::uint32_t b;
    std::size_t surfaces;
  };
  // On an edge, on a corner, and on the diagonal of a face. The last one begins inside the cube, so it is a wall.
  for (const auto& [a, b, surfaces] : {Fin{0, 1, 1}, Fin{7, 8, 1}, Fin{1, 2, 0}})
  {
    const MeshPointer with_fin = changed(cube(),
                                         [a = a, b = b](Mesh& mesh)
                                         {
                                           mesh.vertices.push_back({3.0, 3.1, 3.2});
                                           mesh.vertices.push_back({3.0, -3.1, 3.2});
                                           mesh.triangles.push_back({a, b, 9});
                                         });
    const auto solid = solidMeshOf(with_fin);
    EXPECT_TRUE(contains(*solid, {0.01, 0.02, 0.03}));
    EXPECT_FALSE(contains(*solid, {1.5, 1.4, 1.3}));
    EXPECT_EQ(solid->parts.count(PartKind::Surface), surfaces);
    EXPECT_FALSE(solid->isAllSolid());
  }
}

TEST(SolidMesh, BoundsByParityWhereNoDirectionIsPossible)
{
  // A Klein bottle that passes through itself: a figure eight that turns by half around an axis.
  constexpr std::uint32_t kAround = 48;
  constexpr std::uint32_t kAcross = 24;
  auto mesh = std::make_shared<Mesh>();
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j)
    {
      const double u = 2.0 * M_PI * i / kAround;
      const double v = 2.0 * M_PI * (j + 0.5) / kAcross;
      const double r = 4.0 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
      mesh->vertices.emplace_back(r * std::cos(u), r * std::sin(u),
                                  std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v));
    }
  // After one turn the eight is mirrored: v becomes -v.
  const auto at = [](std::uint32_t i, std::uint32_t j)
  { return i < kAround ? i * kAcross + j % kAcross : (2 * kAcross - 1 - j % kAcross) % kAcross; };
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j)
    {
      mesh->triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh->triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  const auto solid = solidMeshOf(mesh);
  EXPECT_EQ(solid->parts.count(PartKind::Mended), 1U);
  EXPECT_EQ(solid->roles.front(), TriangleRole::Parity);
  EXPECT_TRUE(contains(*solid, {4.7, 0.05, 0.01})) << "in a lobe of the eight";
  EXPECT_FALSE(contains(*solid, {0.01, 0.02, 0.03})) << "on the axis";
}

TEST(SolidMesh, FillsSmallHolesOnly)
{
  const MeshPointer ball =
      closedSurface("ball", 400, 2.0,
                    [](double along, double angle)
                    {
                      const double r = std::sin(M_PI * along);
                      return Vector3d(r * std::cos(angle), r * std::sin(angle), std::cos(M_PI * along));
                    });
  std::size_t filled = 0;
  std::size_t open = 0;
  for (std::size_t missing = 1; missing < 200; missing += 11)
  {
    // The triangles of a ball of rings are in the order of their columns: a slice is missing.
    const MeshPointer mesh = changed(ball, [&](Mesh& copy) { copy.triangles.resize(copy.triangles.size() - missing); });
    const auto solid = solidMeshOf(mesh);
    ASSERT_EQ(solid->parts.other.size(), 1U);
    const MeshPart& part = solid->parts.other.front();
    EXPECT_EQ(part.triangles, mesh->triangles.size());
    EXPECT_GE(part.holes, 1U);
    EXPECT_EQ(part.kind, part.hole_share <= kSmallHoles ? PartKind::Filled : PartKind::Surface);
    EXPECT_EQ(contains(*solid, {0.02, 0.3, 0.1}), part.kind == PartKind::Filled);
    EXPECT_FALSE(contains(*solid, {0.02, 1.3, 0.1}));
    (part.kind == PartKind::Filled ? filled : open) += 1;
    EXPECT_TRUE(contains(changed(mesh, [](Mesh& copy) { copy.solid = SolidRule::Filled; }), {0.02, 0.3, 0.1}));
  }
  EXPECT_GT(filled, 2U);
  EXPECT_GT(open, 2U);
}

TEST(SolidMesh, IsFoundFarFromTheOriginAndForManySeparateTriangles)
{
  auto sliver = std::make_shared<Mesh>();
  sliver->vertices = {{1e5, 0.0, 0.0}, {1e5, 0.0, 0.0}, {1e5, 0.0, 1e-10}};
  sliver->triangles = {{0, 1, 2}};
  EXPECT_FALSE(solidMeshOf(sliver)->hasSolid());

  auto soup = std::make_shared<Mesh>();
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (std::uint32_t i = 0; i < 5000; ++i)
  {
    const Vector3d place(uniform(generator), uniform(generator), uniform(generator));
    for (int corner = 0; corner < 3; ++corner)
      soup->vertices.push_back(place + 0.01 * Vector3d(uniform(generator), uniform(generator), uniform(generator)));
    soup->triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  soup->vertices[0] = {1e5, 0.0, 0.0};  // far away: the tolerances are long against the triangles
  const auto solid = solidMeshOf(soup);
  EXPECT_FALSE(solid->hasSolid());
  EXPECT_GE(solid->parts.count(PartKind::Surface), 1U);
}

TEST(SolidMesh, OfTheRuleSurfaceHasNothingInside)
{
  const auto solid = solidMeshOf(changed(cube(), [](Mesh& mesh) { mesh.solid = SolidRule::Surface; }));
  EXPECT_FALSE(solid->hasSolid());
  EXPECT_FALSE(contains(*solid, {0.01, 0.02, 0.03}));
}

/// For each directed edge, by the coordinates of its ends: how much more often the triangles that count run along it
/// than against it.
std::size_t openEdges(const SolidMesh& solid)
{
  using Corner = std::array<double, 3>;
  std::map<std::array<Corner, 2>, std::pair<int, int>> uses;
  for (std::size_t i = 0; i < solid.roles.size(); ++i)
    for (std::size_t k = 0; k < 3 && solid.roles[i] != TriangleRole::Surface; ++k)
    {
      const Vector3d& a = solid.mesh->vertices[solid.mesh->triangles[i][k]];
      const Vector3d& b = solid.mesh->vertices[solid.mesh->triangles[i][(k + 1) % 3]];
      const Corner from = {a.x() + 0.0, a.y() + 0.0, a.z() + 0.0};
      const Corner to = {b.x() + 0.0, b.y() + 0.0, b.z() + 0.0};
      auto& [sum, odd] = uses[from < to ? std::array{from, to} : std::array{to, from}];
      if (solid.roles[i] == TriangleRole::Winding)
        sum += from < to ? 1 : -1;
      else
        ++odd;
    }
  return static_cast<std::size_t>(std::count_if(
      uses.begin(), uses.end(), [](const auto& use) { return use.second.first != 0 || use.second.second % 2 != 0; }));
}

/// The distance of a point from the triangles of a mesh, by brute force over samples of them.
double sampledDistance(const Mesh& mesh, const Vector3d& point)
{
  double least = std::numeric_limits<double>::max();
  for (const auto& t : mesh.triangles)
    for (int i = 0; i <= 6; ++i)
      for (int k = 0; i + k <= 6; ++k)
        least = std::min(
            least,
            ((i * mesh.vertices[t[0]] + k * mesh.vertices[t[1]] + (6 - i - k) * mesh.vertices[t[2]]) / 6.0 - point)
                .norm());
  return least;
}

MeshPointer insideOut(const MeshPointer& mesh)
{
  return changed(
      mesh,
      [](Mesh& copy)
      {
        for (auto& t : copy.triangles)
          std::swap(t[1], t[2]);
      });
}

MeshPointer placed(const MeshPointer& mesh, const Eigen::Isometry3d& pose, double scale = 1.0)
{
  return changed(
      mesh,
      [&](Mesh& copy)
      {
        for (Vector3d& vertex : copy.vertices)
          vertex = pose * (scale * vertex);
      });
}

TEST(SolidMesh, HasAllThatItsShellsHaveWhateverTheirDirections)
{
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const std::vector<MeshPointer> bodies = {cube(), torusMesh(1.0, 0.4), tessellate(Cylinder{0.6, 2.0}).mesh};
  std::size_t in_both = 0;
  for (int repetition = 0; repetition < repetitions(40, 2000); ++repetition)
  {
    // A long bar through each of the bodies: neither is entirely in the other. Its ends may both be in the body.
    const MeshPointer& body = bodies[repetition % 3];
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(0.5 * Vector3d(uniform(generator), uniform(generator), uniform(generator))) *
        Eigen::Quaterniond::UnitRandom();
    MeshPointer bar = tessellate(Box{{0.3, 0.4, repetition % 2 == 0 ? 4.0 : 2.0}}).mesh;
    bar = placed(bar, repetition % 3 == 1 && repetition % 2 == 1 ? Eigen::Isometry3d::Identity() : pose);
    bar = repetition % 3 == 1 && repetition % 2 == 1
              ? placed(bar, Eigen::Translation3d(0.0, 0.0, 0.1) *
                                Eigen::AngleAxisd(M_PI / 2, Vector3d(1.0, uniform(generator), 0.0).normalized()))
              : bar;
    const MeshPointer a = generator() % 2 == 0 ? body : insideOut(body);
    const MeshPointer b = generator() % 2 == 0 ? bar : insideOut(bar);
    const auto solid = solidMeshOf(repetition % 4 < 2 ? together(a, b) : together(b, a));
    bool crosses = false;
    for (const Vector3d& vertex : bar->vertices)
      crosses = crosses || !isInside(body, vertex);
    for (int i = 0; i < 30 && crosses; ++i)
    {
      Vector3d point(1.2 * uniform(generator), 1.2 * uniform(generator), 1.2 * uniform(generator));
      if (i % 2 == 0)  // in the bar
      {
        const Vector3d& corner = bar->vertices[generator() % 8];
        const Vector3d center = 0.5 * (bar->vertices.front() + bar->vertices.back());
        point = center + 0.95 * std::abs(uniform(generator)) * (corner - center);
      }
      const bool in_a = isInside(body, point);
      const bool in_b = isInside(bar, point);
      ASSERT_EQ(contains(*solid, point), in_a || in_b)
          << "repetition " << repetition << ", seed " << kSeed << ", in body " << in_a << ", in bar " << in_b;
      in_both += in_a && in_b ? 1 : 0;
    }
  }
  EXPECT_GT(in_both, 20U);

  // Two cubes that share an edge and overlap, one of them inside out: their triangles meet at this edge.
  const Eigen::Isometry3d turn = Eigen::Translation3d(1.0, 1.0, 0.0) * Eigen::AngleAxisd(0.5, Vector3d::UnitZ()) *
                                 Eigen::Translation3d(-1.0, -1.0, 0.0);
  const auto at_edge =
      solidMeshOf(together(cube(), changed(insideOut(placed(cube(), turn)),
                                           [](Mesh& mesh)
                                           {
                                             for (Vector3d& vertex : mesh.vertices)
                                               if ((vertex.head<2>() - Eigen::Vector2d(1, 1)).norm() < 1e-9)
                                                 vertex.head<2>() = Eigen::Vector2d(1, 1);
                                           })));
  EXPECT_EQ(at_edge->components.size(), 1U);
  EXPECT_TRUE(contains(*at_edge, {0.01, 0.02, 0.03})) << "in both";
  EXPECT_EQ(at_edge->parts.count(PartKind::Mended), 1U);
}

TEST(SolidMesh, KeepsCavities)
{
  const auto box_at = [](double size, const Vector3d& at)
  { return placed(cube(), Eigen::Isometry3d(Eigen::Translation3d(at)), 0.5 * size); };
  const Vector3d origin = Vector3d::Zero();
  const Vector3d in_middle(0.01, 0.02, 0.03);
  const Vector3d in_wall(0.95, 0.02, 0.03);
  // A second body, apart or overlapping, with any direction.
  for (const double away : {-1.7, 5.0})
    for (const bool is_out : {false, true})
    {
      const MeshPointer other = is_out ? insideOut(box_at(2.0, {away, 0.0, 0.0})) : box_at(2.0, {away, 0.0, 0.0});
      for (const bool mirrored : {false, true})
      {
        const auto with = [&](const MeshPointer& mesh)
        { return solidMeshOf(together(mirrored ? insideOut(mesh) : mesh, other)); };
        const MeshPointer hollow = together(box_at(2.0, origin), insideOut(box_at(1.2, origin)));
        EXPECT_FALSE(contains(*with(hollow), in_middle));
        EXPECT_TRUE(contains(*with(hollow), in_wall));
        EXPECT_TRUE(contains(*with(hollow), {away - 0.9, 0.0, 0.0}));
        EXPECT_TRUE(contains(*with(together(box_at(2.0, origin), box_at(1.2, origin))), in_middle)) << "same direction";
        for (const MeshPointer& island : {box_at(0.6, origin), insideOut(box_at(0.6, origin))})
          EXPECT_TRUE(contains(*with(together(hollow, island)), in_middle)) << "a body in the cavity";
        const MeshPointer islands = together(box_at(0.6, origin), insideOut(box_at(0.6, {0.2, 0.0, 0.0})));
        EXPECT_TRUE(contains(*with(together(hollow, islands)), in_middle)) << "two bodies in the cavity";
        EXPECT_FALSE(contains(*with(together(hollow, islands)), {-0.45, 0.02, 0.03})) << "beside them";
      }
    }
}

/// Two boxes side by side, from x = -2 to 0 and from 0 to 2, with `walls` walls between them. Each side is a grid of
/// 4 x 4 squares.
MeshPointer chambers(int walls)
{
  auto mesh = std::make_shared<Mesh>();
  const auto square = [&](const Vector3d& corner, const Vector3d& u, const Vector3d& v)
  {
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k)
      {
        const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
        for (const auto& [p, q] : {std::pair(i, k), std::pair(i + 1, k), std::pair(i + 1, k + 1), std::pair(i, k + 1)})
          mesh->vertices.push_back(corner + 0.25 * p * u + 0.25 * q * v);
        mesh->triangles.push_back({first, first + 1, first + 2});
        mesh->triangles.push_back({first, first + 2, first + 3});
      }
  };
  const Vector3d x(2.0, 0.0, 0.0);
  const Vector3d y(0.0, 2.0, 0.0);
  const Vector3d z(0.0, 0.0, 2.0);
  for (const double begin : {-2.0, 0.0})
  {
    const Vector3d corner(begin, -1.0, -1.0);
    square(corner, y, x);
    square(corner + z, x, y);
    square(corner, x, z);
    square(corner + y, z, x);
  }
  square({-2.0, -1.0, -1.0}, z, y);
  square({2.0, -1.0, -1.0}, y, z);
  for (int wall = 0; wall < walls; ++wall)
    square({0.0, -1.0, -1.0}, wall % 2 == 0 ? y : z, wall % 2 == 0 ? z : y);
  return mesh;
}

TEST(SolidMesh, OfTwoChambersHasBothWhateverIsBetweenThem)
{
  const Vector3d left(-0.91, 0.02, 0.03);
  const Vector3d right(1.13, 0.02, 0.03);
  std::mt19937_64 generator(kSeed);
  for (const int walls : {0, 1, 2, 3})
    for (int missing = -1; missing < repetitions(24, 400); ++missing)
    {
      const std::size_t gone = generator() % chambers(walls)->triangles.size();
      const MeshPointer mesh =
          changed(chambers(walls),
                  [&](Mesh& copy)
                  {
                    if (missing >= 0)
                      copy.triangles.erase(copy.triangles.begin() + static_cast<std::ptrdiff_t>(gone));
                    for (auto& t : copy.triangles)
                      if (generator() % 4 == 0)
                        std::swap(t[0], t[1]);
                  });
      const std::string what = std::to_string(walls) + " walls, without triangle " +
                               (missing < 0 ? "none" : std::to_string(gone)) + ", seed " + std::to_string(kSeed);
      const auto solid = solidMeshOf(mesh);
      EXPECT_EQ(openEdges(*solid), 0U) << what;
      EXPECT_TRUE(contains(*solid, left)) << what;
      EXPECT_TRUE(contains(*solid, right)) << what;
      EXPECT_FALSE(contains(*solid, {2.2, 0.02, 0.03})) << what;
      // A wall with a hole has free edges inside the solid.
      EXPECT_EQ(solid->parts.count(PartKind::Mended) + solid->parts.count(PartKind::Filled), 1U) << what;
    }
}

TEST(SolidMesh, OfManyChambersHasAll)
{
  // A row of three and a cross of four chambers with single walls. The walls are wavy: larger than what they close.
  auto mesh = std::make_shared<Mesh>();
  const auto wall = [&](const Vector3d& corner, const Vector3d& u, const Vector3d& v, double wave)
  {
    const Vector3d normal = u.cross(v).normalized();
    const auto at = [&](int i, int k) -> Vector3d
    {
      const bool is_rim = i == 0 || i == 8 || k == 0 || k == 8;
      return corner + 0.125 * i * u + 0.125 * k * v + (is_rim ? 0.0 : wave * ((i + k) % 2 == 0 ? 1.0 : -1.0)) * normal;
    };
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 8; ++k)
      {
        const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
        for (const auto& [p, q] : {std::pair(i, k), std::pair(i + 1, k), std::pair(i + 1, k + 1), std::pair(i, k + 1)})
          mesh->vertices.push_back(at(p, q));
        mesh->triangles.push_back({first, first + 1, first + 2});
        mesh->triangles.push_back({first, first + 2, first + 3});
      }
  };
  const Vector3d x = Vector3d::UnitX();
  const Vector3d y = Vector3d::UnitY();
  const Vector3d z = Vector3d::UnitZ();
  std::vector<Vector3d> chambers;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k)
    {
      if (k == 2 && i == 3)
        continue;
      const Vector3d corner(i, k, 0.0);
      chambers.push_back(corner + Vector3d(0.501, 0.502, 0.503));
      wall(corner, x, y, 0.0);
      wall(corner + z, x, y, 0.0);
      wall(corner, y, z, i == 0 ? 0.0 : 0.08);
      wall(corner, x, z, k == 0 ? 0.0 : 0.08);
      if (i == 3 || (k == 2 && i == 2))
        wall(corner + x, y, z, 0.0);
      if (k == 2 || i == 3)
      {
        if (k == 2 || (k == 1 && i == 3))
          wall(corner + y, x, z, 0.0);
      }
    }
  const auto solid = solidMeshOf(mesh);
  EXPECT_EQ(openEdges(*solid), 0U);
  EXPECT_EQ(solid->parts.count(PartKind::Surface), 0U);
  for (const Vector3d& chamber : chambers)
    EXPECT_TRUE(contains(*solid, chamber)) << chamber.transpose();
  EXPECT_FALSE(contains(*solid, {3.501, 2.502, 0.503})) << "the corner without a chamber";
  EXPECT_FALSE(contains(*solid, {-0.2, 0.502, 0.503}));
}

/// Takes triangles away from a mesh, at random places or around one place, while they have at most `share` of the area
/// that is left.
struct Removed
{
  MeshPointer mesh;
  double share;
  std::vector<Vector3d> lost;  // the corners of the missing triangles
};

Removed withoutShare(const Mesh& mesh, double share, bool in_one_place, std::mt19937_64& generator)
{
  const auto corner = [&](std::size_t t, std::size_t i) { return mesh.vertices[mesh.triangles[t][i]]; };
  std::vector<std::size_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), generator);
  const Vector3d place = corner(order[0], 0);
  if (in_one_place)
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b)
              { return (corner(a, 0) - place).norm() < (corner(b, 0) - place).norm(); });
  std::vector<double> areas;
  for (std::size_t t = 0; t < order.size(); ++t)
    areas.push_back(0.5 * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm());
  const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
  auto copy = std::make_shared<Mesh>(mesh);
  copy->triangles.clear();
  Removed removed{copy, 0.0, {}};
  double lost = 0.0;
  for (const std::size_t t : order)
    if (lost + areas[t] <= share / (1.0 + share) * all)
    {
      lost += areas[t];
      removed.lost.insert(removed.lost.end(), {corner(t, 0), corner(t, 1), corner(t, 2)});
    }
    else
      copy->triangles.push_back(mesh.triangles[t]);
  removed.share = lost / (all - lost);
  return removed;
}

TEST(SolidMesh, ChangesAnswersBesideItsHolesOnlyAboveTheLimit)
{
  const std::vector<MeshPointer> meshes = {torusMesh(1.0, 0.4), closedSurface("ball", 600, 2.0,
                                                                              [](double along, double angle)
                                                                              {
                                                                                const double r = std::sin(M_PI * along);
                                                                                return Vector3d(r * std::cos(angle),
                                                                                                r * std::sin(angle),
                                                                                                std::cos(M_PI * along));
                                                                              })};
  std::mt19937_64 generator(kSeed);
  std::cout << "missing area  in one place  at random places (share of the inner points that are lost)\n";
  for (const double share : {0.01, 0.02, 0.05, 0.09, 0.11, 0.15, 0.2, 0.3, 0.5})
  {
    std::cout << std::setw(12) << share;
    for (const bool in_one_place : {true, false})
    {
      std::size_t inside = 0;
      std::size_t lost = 0;
      for (int repetition = 0; repetition < repetitions(4, 100); ++repetition)
      {
        const MeshPointer& mesh = meshes[repetition % 2];
        const Removed removed = withoutShare(*mesh, share, in_one_place, generator);
        Eigen::AlignedBox3d hole;
        for (const Vector3d& point : removed.lost)
          hole.extend(point);
        const auto solid = solidMeshOf(removed.mesh);
        for (int i = 0; i < 60; ++i)
        {
          const Vector3d point(1.4 * std::uniform_real_distribution<>(-1.0, 1.0)(generator),
                               1.4 * std::uniform_real_distribution<>(-1.0, 1.0)(generator),
                               std::uniform_real_distribution<>(-1.0, 1.0)(generator));
          const bool expected = isInside(mesh, point);
          const bool found = contains(*solid, point);
          inside += expected ? 1 : 0;
          lost += expected && !found ? 1 : 0;
          const bool is_beside = removed.share >= kSmallHoles || (in_one_place && hole.contains(point));
          EXPECT_TRUE(found == expected || is_beside || sampledDistance(*mesh, point) < 0.05)
              << share << (in_one_place ? ", one place" : ", random places") << ", point " << point.transpose()
              << ", seed " << kSeed;
        }
      }
      std::cout << std::setw(14) << static_cast<double>(lost) / static_cast<double>(inside);
      // What is left of a mesh may be cut into pieces, and a piece of it may be closed.
      EXPECT_TRUE(share < 2.0 * kSmallHoles || 10 * lost > 9 * inside) << share;
    }
    std::cout << "\n";
  }
}

TEST(SolidMesh, OfADamagedMeshHasTheInsideOfTheUndamagedOne)
{
  const std::vector<MeshPointer> meshes = {
      cube(), torusMesh(1.0, 0.4), tessellate(Cylinder{0.01, 0.03}).mesh, tessellate(Cone{3.0, 1.0}).mesh,
      closedSurface("pear", 600, 1.5,
                    [](double along, double angle)
                    {
                      const double r = (0.3 + 0.7 * along) * std::sin(M_PI * along);
                      return Vector3d(r * std::cos(angle), r * std::sin(angle), 2.0 * along);
                    })};
  std::mt19937_64 generator(kSeed);
  std::size_t inside = 0;
  std::size_t tried = 0;
  for (int repetition = 0; repetition < repetitions(2, 250); ++repetition)
    for (const MeshPointer& mesh : meshes)
      for (const MeshDamage damage : allMeshDamages())
      {
        // Two faults in one mesh. What closes missing and cracked triangles has less than kSmallHoles of the area.
        const double share = damage == MeshDamage::Deleted   ? 0.03
                             : damage == MeshDamage::Cracked ? 0.1
                                                             : std::uniform_real_distribution<>(0.0, 0.9)(generator);
        MeshPointer broken = damaged(*mesh, damage, share, generator);
        if (damage != MeshDamage::FrontAndBack && mesh->triangles.size() > 100)
          broken = damaged(*broken, MeshDamage::Flipped, 0.1, generator);
        const std::string what = mesh->name + ", " + nameOf(damage) + ", repetition " + std::to_string(repetition);
        const auto solid = solidMeshOf(broken);
        ASSERT_EQ(openEdges(*solid), 0U) << what;
        // A triangle whose neighbours are missing, or that is as small as its crack, may remain a surface.
        const bool is_all_solid = damage != MeshDamage::Cracked && damage != MeshDamage::Deleted;
        ASSERT_TRUE(!is_all_solid || solid->parts.count(PartKind::Surface) == 0) << what << ", seed " << kSeed;
        ASSERT_TRUE(std::equal(broken->vertices.begin(), broken->vertices.end(), solid->mesh->vertices.begin()));
        Eigen::AlignedBox3d box;
        for (const Vector3d& vertex : mesh->vertices)
          box.extend(vertex);
        double largest_hole = 2e-3 * box.diagonal().norm();
        for (const MeshPart& part : solid->parts.other)
          largest_hole = std::max(largest_hole, part.largest_hole);
        for (int i = 0; i < 10; ++i)
        {
          const Vector3d point = box.sample();
          const bool expected = isInside(mesh, point);
          if (contains(*solid, point) == expected)
            inside += expected ? 1 : 0;
          else
            ASSERT_LT(sampledDistance(*mesh, point), largest_hole) << what;
          ++tried;
        }
      }
  EXPECT_GT(inside, tried / 10);
}
}  // namespace
}  // namespace gpu_planning_scene::core
