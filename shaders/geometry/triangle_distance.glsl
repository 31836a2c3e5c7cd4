// Compares the distance of two triangles with a required distance. The nearest points are searched among edges and
// corners (Ericson 2005, "Real-Time Collision Detection", 5.1). The accuracy of the search does not matter. The
// distance of the found points is an upper bound on the distance of the triangles, and the extents of the corners along
// the line between these points give a lower bound. A degenerate triangle may make the found points NaN. The last two
// comparisons then prove nothing.
#include "common/comparisons.glsl"

struct Witness
{
  vec3 on_a;
  vec3 on_b;
  float squared;
};

void keepNearer(vec3 on_a, vec3 on_b, inout Witness best)
{
  const vec3 between = on_b - on_a;
  const float squared = dot(between, between);
  if (squared < best.squared)
    best = Witness(on_a, on_b, squared);
}

// numerator / denominator, clamped to [0, 1]. A NaN becomes 0, which is still a point of the edge.
float fraction(float numerator, float denominator)
{
  const float t = numerator / denominator;
  return t > 0.0 ? min(t, 1.0) : 0.0;
}

void edgeEdge(vec3 p, vec3 along_p, vec3 q, vec3 along_q, inout Witness best)
{
  const vec3 between = p - q;
  const float pp = dot(along_p, along_p);
  const float qq = dot(along_q, along_q);
  const float pq = dot(along_p, along_q);
  const float p_between = dot(along_p, between);
  const float q_between = dot(along_q, between);
  float s = fraction(pq * q_between - p_between * qq, pp * qq - pq * pq);
  const float t = fraction(pq * s + q_between, qq);
  s = fraction(pq * t - p_between, pp);
  keepNearer(p + s * along_p, q + t * along_q, best);
}

// Projects a corner onto the plane of the other triangle. Returns true if the foot lies within that triangle.
bool footWithin(vec3 corner, vec3 origin, vec3 e1, vec3 e2, out vec3 foot)
{
  const vec3 to = corner - origin;
  const vec3 normal = cross(e1, e2);
  const float area = dot(normal, normal);
  const float s = dot(cross(to, e2), normal) / area;
  const float t = dot(cross(e1, to), normal) / area;
  foot = origin + s * e1 + t * e2;
  return s >= 0.0 && t >= 0.0 && s + t <= 1.0;
}

// This test follows trianglePair, for triangles that are not proven to meet. Returns STATE_HIT if their distance is
// proven to be at most `distance`, 0 if it is proven to be more than `gap`, else STATE_UNDECIDED. In: the corners in
// one frame (metres); the corners of b are off by at most `error` relative to the corners of a.
uint triangleDistance(vec3 a[3], vec3 b[3], float error, float distance, float gap)
{
  // Relative to a corner. Without `precise`, a compiler may add a point's terms in another order, and lose this.
  precise vec3 pa[3];
  precise vec3 pb[3];
  for (int i = 0; i < 3; ++i)
  {
    pa[i] = a[i] - a[0];
    pb[i] = b[i] - a[0];
  }
  Witness best = Witness(pa[0], pb[0], 3.4e38);
  float size = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const int i1 = (i + 1) % 3;
    vec3 foot;
    if (footWithin(pa[i], pb[0], pb[1] - pb[0], pb[2] - pb[0], foot))
      keepNearer(pa[i], foot, best);
    if (footWithin(pb[i], pa[0], pa[1], pa[2], foot))
      keepNearer(foot, pb[i], best);
    for (int j = 0; j < 3; ++j)
      edgeEdge(pa[i], pa[i1] - pa[i], pb[j], pb[(j + 1) % 3] - pb[j], best);
    size = max(size, length(pa[i]) + length(pb[i]));
  }
  precise const vec3 axis = best.on_b - best.on_a;
  float from_a = -3.4e38;
  float from_b = 3.4e38;
  for (int i = 0; i < 3; ++i)
  {
    precise const vec3 to_a = pa[i] - best.on_a;
    precise const vec3 to_b = pb[i] - best.on_a;
    from_a = max(from_a, dot(axis, to_a));
    from_b = min(from_b, dot(axis, to_b));
  }
  const float span = lengthAtMost(axis) * (1.0 + 8.0 * u);
  const float off = error + 24.0 * u * size;
  if (provenGreater(distance * (1.0 - 4.0 * u), span + off))
    return STATE_HIT;
  return provenGreater(from_b - from_a, span * (gap + off) * (1.0 + 8.0 * u) + TINY) ? 0u : STATE_UNDECIDED;
}
