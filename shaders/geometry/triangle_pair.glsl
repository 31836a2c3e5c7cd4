// The test of two triangles that meet or are apart by a gap, with error bounds. Source: see trianglePair.
#include "geometry/triangle_error_bounds.glsl"

bool onOppositeSides(float first, float second, float error)
{
  return (first > error && second < -error) || (first < -error && second > error);
}

// Tests two triangles. Returns STATE_HIT if they are proven to meet, 0 if they are proven to be more than `gap` apart,
// else STATE_UNDECIDED. In: the corners of a and b in one frame (metres). The shape of b was placed with its origin at
// `origin_b`; the corners of b are off by at most `error` relative to the corners of a.
// The test uses the six distances of corners to the plane of the other triangle, and the nine volumes that an edge of a
// spans with an edge of b. Devillers and Guigue ("Faster Triangle-Triangle Intersection Tests", 2002) decide by their
// signs. A hit is an edge that pierces the other triangle. The triangles are apart if one of eleven axes separates
// them: the two normals and the nine cross products of edges.
// A sign counts only if the value exceeds its error bound. An axis need not be exact, but it counts only if it
// certainly separates all corners (docs/error_bounds.md). Comparisons are written so that a NaN proves nothing.
uint trianglePair(vec3 a[3], vec3 b[3], vec3 origin_b, float error, float gap)
{
  precise vec3 r[3];  // b's corners relative to a's first one: differences of close numbers lose no digits
  precise vec3 ea[3];
  precise vec3 eb[3];
  for (int i = 0; i < 3; ++i)
  {
    const int next = (i + 1) % 3;
    r[i] = b[i] - a[0];
    ea[i] = a[next] - a[i];
    eb[i] = b[next] - b[i];
  }
  precise const vec3 na = cross(ea[0], ea[1]);
  precise const vec3 nb = cross(eb[0], eb[1]);
  const TriangleErrorBounds bounds = triangleErrorBounds(a, b, r, ea, eb, origin_b, error, gap);
  const float squared_separation = bounds.separation * bounds.separation * (1.0 + 32.0 * u);

  precise float da[3];
  precise float db[3];
  for (int i = 0; i < 3; ++i)
  {
    da[i] = dot(nb, a[i] - b[0]);
    db[i] = dot(na, r[i]);
  }
  const float gap_a = max(min(da[0], min(da[1], da[2])), -max(da[0], max(da[1], da[2])));
  const float gap_b = max(min(db[0], min(db[1], db[2])), -max(db[0], max(db[1], db[2])));
  bool apart = gap_a > separationAlong(nb, bounds.separation, bounds.length_b) ||
               gap_b > separationAlong(na, bounds.separation, bounds.length_a);
  bool hit = false;

  // For each edge of b: true while its volumes with the edges of a are all certainly positive (above), or negative
  // (below).
  bvec3 b_edge_above = bvec3(true);
  bvec3 b_edge_below = bvec3(true);
  for (int i = 0; i < 3; ++i)
  {
    const int i1 = (i + 1) % 3;
    precise const float span_b = dot(nb, ea[i]);  // extent of b along the axis, from edge j to the opposite corner
    bool all_above = true;
    bool all_below = true;
    for (int j = 0; j < 3; ++j)
    {
      precise const vec3 axis = cross(ea[i], eb[j]);
      precise const float volume = dot(axis, b[j] - a[i]);
      precise const float span_a = -dot(na, eb[j]);  // extent of a
      const float separation =
          max(volume + min(0.0, span_b) - max(0.0, span_a), min(0.0, span_a) - volume - max(0.0, span_b));
      const float certain = separation - bounds.span;
      apart = apart ||
              (certain > LEAST_SQUARED && certain * certain > squared_separation * (dot(axis, axis) + LOST_SQUARE));
      all_above = all_above && volume > bounds.volume;
      all_below = all_below && volume < -bounds.volume;
      b_edge_above[j] = b_edge_above[j] && volume > bounds.volume;
      b_edge_below[j] = b_edge_below[j] && volume < -bounds.volume;
    }
    const bool crosses = onOppositeSides(da[i], da[i1], bounds.height_a);
    hit = hit || (crosses && (all_above || all_below));
  }
  for (int j = 0; j < 3; ++j)
  {
    const int j1 = (j + 1) % 3;
    const bool crosses = onOppositeSides(db[j], db[j1], bounds.height_b);
    hit = hit || (crosses && (b_edge_above[j] || b_edge_below[j]));
  }
  return hit ? STATE_HIT : (apart ? 0u : STATE_UNDECIDED);
}
