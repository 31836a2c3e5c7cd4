// Two triangles: proven to meet (STATE_HIT), proven to be apart (0), or undecided (STATE_UNDECIDED).
// a and b are the corners in one frame, metres. Uses the six distances of corners to the other's plane and the nine
// volumes that an edge of a spans with an edge of b (Devillers and Guigue 2002 decide by their signs):
// a hit is an edge that pierces the other triangle, apart is a separating axis out of the two normals and the nine
// products of edges. Signs count only beyond a bound on the rounding: `error` metres for the position of b against a, and
// a few units of 2^-23 for the arithmetic. Apart also needs a gap of more than `slack` metres. Degenerate and coplanar
// triangles come out undecided or apart, never hit.
uint trianglePair(vec3 a[3], vec3 b[3], float error, float slack)
{
  const float u = 1.1920929e-7;
  // Everything relative to a's first corner: differences of close numbers lose nothing.
  const vec3 ea[3] = vec3[3](a[1] - a[0], a[2] - a[1], a[0] - a[2]);
  const vec3 eb[3] = vec3[3](b[1] - b[0], b[2] - b[1], b[0] - b[2]);
  const vec3 na = cross(ea[0], ea[1]);
  const vec3 nb = cross(eb[0], eb[1]);

  float length_a = 0.0;
  float length_b = 0.0;
  float reach = 0.0;  // the largest distance between corners that enters a product
  float scale = 0.0;  // the largest coordinate: edges of b carry its rounding
  for (int i = 0; i < 3; ++i)
  {
    const vec3 r = b[i] - a[0];
    length_a = max(length_a, dot(ea[i], ea[i]));
    length_b = max(length_b, dot(eb[i], eb[i]));
    reach = max(reach, dot(r, r));
    const vec3 size = max(abs(a[i]), abs(b[i]));
    scale = max(scale, max(size.x, max(size.y, size.z)));
  }
  length_a = sqrt(length_a);
  length_b = sqrt(length_b);
  reach = sqrt(reach) + length_a + length_b;
  const float offset = error + 16.0 * u * reach;  // of a point from a plane, per unit of the normal's longest edges
  const float turn = 8.0 * u * scale * reach;     // what the rounding of b's edges adds, per edge of the other factor
  const float error_b = length_a * (length_a * offset);
  const float error_a = length_b * (length_b * offset + 2.0 * turn);
  const float error_v = length_a * (length_b * offset + turn);
  const float error_span = u * length_a * (length_b * (4.0 * length_b + 32.0 * scale) + length_a * (4.0 * length_b + 8.0 * scale));

  float da[3];
  float db[3];
  for (int i = 0; i < 3; ++i)
  {
    da[i] = dot(nb, a[i] - b[0]);
    db[i] = dot(na, b[i] - a[0]);
  }
  const float gap_a = max(min(da[0], min(da[1], da[2])), -max(da[0], max(da[1], da[2]))) - error_a - slack * length(nb);
  const float gap_b = max(min(db[0], min(db[1], db[2])), -max(db[0], max(db[1], db[2]))) - error_b - slack * length(na);
  bool apart = gap_a > 0.0 || gap_b > 0.0;
  bool hit = false;

  // One bit per edge pair for the sign of its volume, where it is certain.
  bvec3 b_edge_above = bvec3(true);
  bvec3 b_edge_below = bvec3(true);
  for (int i = 0; i < 3; ++i)
  {
    const int i1 = (i + 1) % 3;
    const float span_b = dot(nb, ea[i]);  // b's extent along the product of edges, from edge j to the corner opposite
    bool all_above = true;
    bool all_below = true;
    for (int j = 0; j < 3; ++j)
    {
      const vec3 axis = cross(ea[i], eb[j]);
      const float volume = dot(axis, b[j] - a[i]);
      const float span_a = -dot(na, eb[j]);  // the same of a
      const float separation = max(volume + min(0.0, span_b) - max(0.0, span_a), min(0.0, span_a) - volume - max(0.0, span_b));
      apart = apart || separation > error_v + error_span + slack * length(axis);
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
