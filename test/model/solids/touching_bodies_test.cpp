// Bodies in one mesh that have faces, edges or outlines in common are solid, whatever their directions and order.

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/solids.h"
#include "model/solids/contains.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// A box with vertices of its own for each face. `other_diagonals`: the faces are cut along their other diagonals.
struct Body
{
  Vector3d low;
  Vector3d high;
  bool is_inside_out = false;
  bool other_diagonals = false;
};

/// The four corners of a face, counter-clockwise from outside.
std::array<Vector3d, 4> faceOf(const Body& body, int axis, bool is_high)
{
  std::array<Vector3d, 4> face;
  for (int k = 0; k < 4; ++k)
  {
    face[k][axis] = is_high ? body.high[axis] : body.low[axis];
    const std::array<int, 2> others = {(axis + 1) % 3, (axis + 2) % 3};
    const std::array<bool, 2> ends = {k == 1 || k == 2, k >= 2};
    for (int i = 0; i < 2; ++i)
      face[k][others[i]] = ends[i] ? body.high[others[i]] : body.low[others[i]];
  }
  if (!is_high)
    std::reverse(face.begin(), face.end());
  return face;
}

void add(const Body& body, Mesh& mesh)
{
  for (int axis = 0; axis < 3; ++axis)
    for (const bool is_high : {false, true})
    {
      std::array<Vector3d, 4> face = faceOf(body, axis, is_high);
      if (body.other_diagonals)
        std::rotate(face.begin(), face.begin() + 1, face.end());
      if (body.is_inside_out)
        std::swap(face[1], face[3]);
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), face.begin(), face.end());
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
}

struct Case
{
  std::string name;
  std::vector<Body> bodies;
};

const std::vector<Case>& cases()
{
  const Vector3d zero = Vector3d::Zero();
  static const std::vector<Case> all = {
      {"a common base", {{zero, {1, 1, 1}}, {zero, {1, 1, 2}}}},
      {"a common base, other diagonals", {{zero, {1, 1, 1}}, {zero, {1, 1, 2}, false, true}}},
      {"a common base, one inside out", {{zero, {1, 1, 1}, true}, {zero, {1, 1, 2}}}},
      {"a common base, other diagonals, one inside out", {{zero, {1, 1, 1}, true, true}, {zero, {1, 1, 2}}}},
      {"a common side", {{zero, {1, 1, 1}}, {zero, {2, 1, 1}}}},
      {"two in a third one", {{zero, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 2}}, {zero, {1, 1, 2}}}},
      {"a wall", {{zero, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 2}}}},
      {"a wall, one inside out", {{zero, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 2}, true}}},
      {"a wall, other diagonals", {{zero, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 2}, false, true}}},
      {"a wall, other diagonals, one inside out", {{zero, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 2}, true, true}}},
      {"a common edge", {{zero, {1, 1, 1}}, {{1, 1, 0}, {2, 2, 1}}}},
      {"a common edge, one inside out", {{zero, {1, 1, 1}}, {{1, 1, 0}, {2, 2, 1}, true}}},
      {"twice the same, and a larger one", {{zero, {1, 1, 1}}, {zero, {1, 1, 1}}, {zero, {1, 1, 2}}}},
      {"front and back", {{zero, {1, 1, 1}}, {zero, {1, 1, 1}, true}}},
      {"four around an edge",
       {{zero, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}, true}, {{0, 1, 0}, {1, 2, 1}}, {{1, 1, 0}, {2, 2, 1}}}},
  };
  return all;
}

TEST(TouchingBodies, AreAllSolid)
{
  for (const Case& each : cases())
  {
    std::vector<std::size_t> order(each.bodies.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      order[i] = i;
    do
    {
      auto mesh = std::make_shared<Mesh>();
      for (const std::size_t i : order)
        add(each.bodies[i], *mesh);
      const auto solid = solidMeshOf(mesh);
      for (const Body& body : each.bodies)
      {
        EXPECT_TRUE(contains(*solid, body.low + (body.high - body.low).cwiseProduct(Vector3d(0.51, 0.47, 0.53))))
            << each.name;
        EXPECT_FALSE(contains(*solid, body.high + Vector3d(0.011, 0.013, 0.017))) << each.name;
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

constexpr int kCells = 3;  // along each axis of a grid

/// Bodies of the cells of a grid. They have faces, edges and outlines in common, and overlap.
class GridBodies
{
 public:
  GridBodies(std::mt19937_64& generator, bool overlap) : generator_(generator)
  {
    std::uniform_int_distribution<int> body(0, kBodies - 1);
    for (int& bodies : of_cell_)
      if (overlap)
        for (int i = 0; i < kBodies; ++i)
          bodies |= chance(0.25) ? 1 << i : 0;
      else
        bodies = chance(0.5) ? 1 << body(generator_) : 0;
  }

  bool isFull(int x, int y, int z) const { return bodiesOf({x, y, z}) != 0; }

  /// `flipped` and `doubled`: the shares of faces with this damage. `inside_out`: that of bodies.
  std::shared_ptr<const Mesh> mesh(double inside_out, double flipped, double doubled)
  {
    auto mesh = std::make_shared<Mesh>();
    for (int body = 0; body < kBodies; ++body)
      addBody(1 << body, chance(inside_out), flipped, doubled, *mesh);
    std::shuffle(mesh->triangles.begin(), mesh->triangles.end(), generator_);
    return mesh;
  }

 private:
  static constexpr int kBodies = 3;
  using Cell = std::array<int, 3>;

  bool chance(double share) { return std::uniform_real_distribution<double>(0.0, 1.0)(generator_) < share; }

  int bodiesOf(const Cell& cell) const
  {
    const bool is_in = std::all_of(cell.begin(), cell.end(), [](int i) { return i >= 0 && i < kCells; });
    return is_in ? of_cell_[(cell[0] * kCells + cell[1]) * kCells + cell[2]] : 0;
  }

  void addBody(int body, bool is_inside_out, double flipped, double doubled, Mesh& mesh)
  {
    std::map<Cell, std::uint32_t> known;
    const auto vertex = [&](Cell corner, int axis_1, int axis_2, int i)
    {
      corner[axis_1] += i == 1 || i == 2 ? 1 : 0;
      corner[axis_2] += i >= 2 ? 1 : 0;
      const auto [entry, is_new] = known.try_emplace(corner, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new)
        mesh.vertices.push_back(0.1 * Vector3d(corner[0], corner[1], corner[2]));
      return entry->second;
    };
    Cell cell;
    for (cell[0] = 0; cell[0] <= kCells; ++cell[0])
      for (cell[1] = 0; cell[1] <= kCells; ++cell[1])
        for (cell[2] = 0; cell[2] <= kCells; ++cell[2])
          for (int axis = 0; axis < 3; ++axis)
          {
            Cell before = cell;
            --before[axis];
            const bool is_here = (bodiesOf(cell) & body) != 0;
            if (is_here == ((bodiesOf(before) & body) != 0))
              continue;
            std::array<std::uint32_t, 4> face;
            const int first = chance(0.5) ? 1 : 0;  // the diagonal
            for (int i = 0; i < 4; ++i)
              face[i] = vertex(cell, (axis + 1) % 3, (axis + 2) % 3, (i + first) % 4);
            const int copies = chance(doubled) ? 2 : 1;
            for (std::array<std::uint32_t, 3> t : {std::array{face[0], face[1], face[2]}, {face[0], face[2], face[3]}})
            {
              if ((is_here != is_inside_out) != chance(flipped))
                std::swap(t[1], t[2]);
              mesh.triangles.insert(mesh.triangles.end(), copies, t);
            }
          }
  }

  std::mt19937_64& generator_;
  std::array<int, kCells * kCells * kCells> of_cell_{};
};

TEST(TouchingBodies, OfAGridAreSolidWhateverTheirDirections)
{
  struct Damage
  {
    bool overlap;
    double inside_out;
    double flipped;
    double doubled;
  };
  const std::vector<Damage> damages = {{true, 0.0, 0.0, 0.0},
                                       {true, 0.5, 0.0, 0.0},
                                       {false, 0.5, 0.1, 0.1},
                                       {false, 0.0, 0.0, 0.1},
                                       {true, 0.5, 0.1, 0.1}};
  std::mt19937_64 generator(kSeed);
  for (int repetition = 0; repetition < repetitions(6, 300); ++repetition)
    for (const Damage& damage : damages)
    {
      GridBodies bodies(generator, damage.overlap);
      const auto solid = solidMeshOf(bodies.mesh(damage.inside_out, damage.flipped, damage.doubled));
      for (int x = 0; x < kCells; ++x)
        for (int y = 0; y < kCells; ++y)
          for (int z = 0; z < kCells; ++z)
            if (bodies.isFull(x, y, z))
              EXPECT_TRUE(contains(*solid, 0.1 * Vector3d(x + 0.513, y + 0.487, z + 0.507)))
                  << "seed " << kSeed << ", repetition " << repetition << ", damage " << (&damage - damages.data());
    }
}
}  // namespace
}  // namespace gpu_planning_scene::core
