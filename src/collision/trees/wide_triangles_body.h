// The source of the test of a leaf's triangles, included once for each instruction set, see wide_triangles.h.
#ifndef GPS_NEAR_TRIANGLES_TEST
#error "define the test's name before this file is included"
#endif

#include "collision/geometry/eight_floats.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Eight vectors.
struct Vectors
{
  Floats x, y, z;
};

inline Vectors operator-(const Vectors& a, const Vectors& b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline Vectors operator+(const Vectors& a, const Vectors& b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Vectors cross(const Vectors& a, const Vectors& b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Floats dot(const Vectors& a, const Vectors& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Corner i of the four triangles of a block, in both halves of the lanes.
inline Vectors allTwice(const TriangleBlock& block, int corner)
{
  const auto& from = block.corners[corner];
  return {loadTwice(from[0]), loadTwice(from[1]), loadTwice(from[2])};
}

/// Corner i of triangle j of a block in the first four lanes, of triangle j + 1 in the others.
inline Vectors twoTriangles(const TriangleBlock& block, int corner, unsigned j)
{
  const auto& from = block.corners[corner];
  return {halves(from[0][j], from[0][j + 1]), halves(from[1][j], from[1][j + 1]), halves(from[2][j], from[2][j + 1])};
}

/// Eight pairs of triangles, relative to the first corner of the first triangle.
struct TrianglePairs
{
  Vectors p1, p2;      ///< the first triangle has the corners 0, p1 and p2
  Vectors q0, q1, q2;  ///< q1 and q2 are relative to q0

  /// Whether the projections on an axis are certainly farther apart than `distance`. `smaller` and `larger` may drop a
  /// NaN, but there is none: corners and distances are finite (Mesh, Variable::largest).
  Ints apartAlong(const Vectors& axis, float distance) const
  {
    // Shorter axes may lose digits to underflow.
    constexpr float kUnderflow = 1e-30F;
    const Floats zero = {};
    const Floats from_p1 = dot(axis, p1);
    const Floats from_p2 = dot(axis, p2);
    const Floats from_q1 = dot(axis, q1);
    const Floats from_q2 = dot(axis, q2);
    const Floats between = dot(axis, q0);
    const Floats p_least = smaller(zero, smaller(from_p1, from_p2));
    const Floats p_most = larger(zero, larger(from_p1, from_p2));
    const Floats q_least = between + smaller(zero, smaller(from_q1, from_q2));
    const Floats q_most = between + larger(zero, larger(from_q1, from_q2));
    const Floats gap = larger(q_least - p_most, p_least - q_most);
    const Floats squared = dot(axis, axis);
    return (squared > kUnderflow) & (gap > distance * squareRoot(squared));
  }

  /// Whether the triangles are certainly farther apart than `distance`.
  Ints apart(float distance) const
  {
    const Vectors p_edges[3] = {p1, p2, p2 - p1};
    const Vectors q_edges[3] = {q1, q2, q2 - q1};
    const Vectors three_q0 = {3.0F * q0.x, 3.0F * q0.y, 3.0F * q0.z};
    Ints found = apartAlong(three_q0 + q1 + q2 - p1 - p2, distance);
    found |= apartAlong(cross(p1, p2), distance);
    found |= apartAlong(cross(q1, q2), distance);
    for (const Vectors& p_edge : p_edges)
    {
      if (bits(found) == 0xff)
        break;
      for (const Vectors& q_edge : q_edges)
        found |= apartAlong(cross(p_edge, q_edge), distance);
    }
    return found;
  }
};
}  // namespace

unsigned GPS_NEAR_TRIANGLES_TEST(const TriangleBlock& a, const TriangleBlock& b, float distance);

unsigned GPS_NEAR_TRIANGLES_TEST(const TriangleBlock& a, const TriangleBlock& b, float distance)
{
  const Vectors p0 = allTwice(a, 0);
  TrianglePairs pairs;
  pairs.p1 = allTwice(a, 1) - p0;
  pairs.p2 = allTwice(a, 2) - p0;
  const unsigned present = (1U << a.count) - 1U;
  unsigned near = 0;
  for (unsigned j = 0; j < b.count; j += 2)
  {
    const Vectors q0 = twoTriangles(b, 0, j);
    pairs.q0 = q0 - p0;
    pairs.q1 = twoTriangles(b, 1, j) - q0;
    pairs.q2 = twoTriangles(b, 2, j) - q0;
    const unsigned in_both = j + 1 < b.count ? present | present << kBlockTriangles : present;
    near |= (~static_cast<unsigned>(bits(pairs.apart(distance))) & in_both) << (kBlockTriangles * j);
  }
  return near;
}
}  // namespace gpu_planning_scene::core
