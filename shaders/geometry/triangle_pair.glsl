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
  float squared_a = 0.0;
  float squared_b = 0.0;
  float squared_r = 0.0;
  float far_a = 0.0;
  float far_b = 0.0;
  float placed_b = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const int next = (i + 1) % 3;
    r[i] = b[i] - a[0];
    ea[i] = a[next] - a[i];
    eb[i] = b[next] - b[i];
    squared_a = max(squared_a, dot(ea[i], ea[i]));
    squared_b = max(squared_b, dot(eb[i], eb[i]));
    squared_r = max(squared_r, dot(r[i], r[i]));
    far_a = max(far_a, dot(a[i], a[i]));
    far_b = max(far_b, dot(b[i] - origin_b, b[i] - origin_b));
    placed_b = max(placed_b, dot(b[i], b[i]));
  }
  far_a = sqrt(far_a);
  far_b = sqrt(far_b);
  placed_b = sqrt(placed_b);
  precise const vec3 na = cross(ea[0], ea[1]);
  precise const vec3 nb = cross(eb[0], eb[1]);

  // edge_a, edge_b: bounds on the errors of edges. Placing b moves all its corners nearly alike, apart from the
  // rounding of each corner. length_a, length_b, reach: upper bounds on the true lengths of the edges, and on the
  // distance between two corners.
  float length_a = sqrt(squared_a) * (1.0 + 8.0 * u);
  float length_b = sqrt(squared_b) * (1.0 + 8.0 * u);
  const float edge_a = u * (1.1 * far_a + length_a);
  const float edge_b = u * (11.7 * far_b + 2.2 * placed_b + 13.0 * length_b);
  length_a += edge_a;
  length_b += edge_b;
  const float reach = sqrt(squared_r) * (1.0 + 8.0 * u) + length_a + length_b + error;
  // Error bounds of the determinants: error_b for the height of a corner of b above a's plane, error_a for the height
  // of a corner of a above b's plane, error_v for a volume.
  const float error_r = error + 8.0 * u * reach;
  const float error_b = length_a * (2.0 * edge_a * reach + length_a * error_r) + TINY;
  const float error_a = length_b * (2.0 * edge_b * reach + length_b * error_r) + TINY;
  const float error_v = (edge_a * length_b + length_a * edge_b) * reach + length_a * length_b * error_r + TINY;
  // beyond: the separation that all corners must have along an axis of length 1. error_span: bound on the error of the
  // extents along a cross product of edges.
  const float beyond = (error + gap + 6.0 * u * reach) * (1.0 + 16.0 * u);
  const float squared_beyond = beyond * beyond * (1.0 + 32.0 * u);
  const float error_span = 20.0 * u * length_a * length_b * (length_a + length_b) + TINY;

  precise float da[3];
  precise float db[3];
  for (int i = 0; i < 3; ++i)
  {
    da[i] = dot(nb, a[i] - b[0]);
    db[i] = dot(na, r[i]);
  }
  const float gap_a = max(min(da[0], min(da[1], da[2])), -max(da[0], max(da[1], da[2])));
  const float gap_b = max(min(db[0], min(db[1], db[2])), -max(db[0], max(db[1], db[2])));
  bool apart = gap_a > beyond * lengthAtMost(nb) + 3.0 * u * length_b * length_b * length_b + TINY ||
               gap_b > beyond * lengthAtMost(na) + 3.0 * u * length_a * length_a * length_a + TINY;
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
      const float certain = separation - error_span;
      apart = apart ||
              (certain > LEAST_SQUARED && certain * certain > squared_beyond * (dot(axis, axis) + LOST_SQUARE));
      all_above = all_above && volume > error_v;
      all_below = all_below && volume < -error_v;
      b_edge_above[j] = b_edge_above[j] && volume > error_v;
      b_edge_below[j] = b_edge_below[j] && volume < -error_v;
    }
    const bool crosses = (da[i] > error_a && da[i1] < -error_a) || (da[i] < -error_a && da[i1] > error_a);
    hit = hit || (crosses && (all_above || all_below));
  }
  for (int j = 0; j < 3; ++j)
  {
    const int j1 = (j + 1) % 3;
    const bool crosses = (db[j] > error_b && db[j1] < -error_b) || (db[j] < -error_b && db[j1] > error_b);
    hit = hit || (crosses && (b_edge_above[j] || b_edge_below[j]));
  }
  return hit ? STATE_HIT : (apart ? 0u : STATE_UNDECIDED);
}
