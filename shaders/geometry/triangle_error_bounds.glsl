// Error bounds of the test of two triangles in triangle_pair.glsl. docs/error_bounds.md derives them. Lengths are in
// metres.

struct TriangleErrorBounds
{
  float length_a;    // upper bounds on the true lengths of the edges
  float length_b;
  float height_a;    // of the height of a corner of a above b's plane, multiplied by the length of b's normal
  float height_b;    // the same for a corner of b above a's plane
  float volume;      // of the volume that an edge of a spans with an edge of b
  float span;        // of the extents along a cross product of edges
  float separation;  // the separation that all corners must have along an axis of length 1
};

float longest(vec3 vectors[3])
{
  return sqrt(max(dot(vectors[0], vectors[0]), max(dot(vectors[1], vectors[1]), dot(vectors[2], vectors[2]))));
}

// a, b: the corners. r: the corners of b relative to a's first one. ea, eb: the edges. origin_b, error, gap: see
// trianglePair.
TriangleErrorBounds triangleErrorBounds(vec3 a[3], vec3 b[3], vec3 r[3], vec3 ea[3], vec3 eb[3], vec3 origin_b,
                                        float error, float gap)
{
  const float far_a = longest(a);
  precise vec3 own_b[3];  // the corners of b relative to the origin of its shape
  for (int i = 0; i < 3; ++i)
    own_b[i] = b[i] - origin_b;
  const float far_b = longest(own_b);
  const float placed_b = longest(b);
  TriangleErrorBounds bounds;
  bounds.length_a = longest(ea) * (1.0 + 8.0 * u);
  bounds.length_b = longest(eb) * (1.0 + 8.0 * u);
  // Errors of the edges. Placing b moves all its corners nearly alike, apart from the rounding of each corner.
  const float edge_a = u * (1.1 * far_a + bounds.length_a);
  const float edge_b = u * (11.7 * far_b + 2.2 * placed_b + 13.0 * bounds.length_b);
  bounds.length_a += edge_a;
  bounds.length_b += edge_b;
  const float a_by_b = bounds.length_a * bounds.length_b;
  // An upper bound on the distance between a corner of a and a corner of b, and the error of this distance.
  const float reach = longest(r) * (1.0 + 8.0 * u) + bounds.length_a + bounds.length_b + error;
  const float error_r = error + 8.0 * u * reach;
  bounds.height_a = bounds.length_b * (2.0 * edge_b * reach + bounds.length_b * error_r) + TINY;
  bounds.height_b = bounds.length_a * (2.0 * edge_a * reach + bounds.length_a * error_r) + TINY;
  bounds.volume = (edge_a * bounds.length_b + bounds.length_a * edge_b) * reach + a_by_b * error_r + TINY;
  bounds.span = 20.0 * u * a_by_b * (bounds.length_a + bounds.length_b) + TINY;
  bounds.separation = (error + gap + 6.0 * u * reach) * (1.0 + 16.0 * u);
  return bounds;
}

// The separation that is needed along the computed normal of a triangle. `longest_edge`: of this triangle.
float separationAlong(vec3 normal, float separation, float longest_edge)
{
  return separation * lengthAtMost(normal) + 3.0 * u * longest_edge * longest_edge * longest_edge + TINY;
}
