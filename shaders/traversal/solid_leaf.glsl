// Tests one triangle of a leaf against a solid: separating axes prove that they are apart, alternating projections
// prove a hit. triangleSolid names the sources. Lengths are in metres.
#include "common/comparisons.glsl"
#include "geometry/error_bounds.glsl"
#include "geometry/pose.glsl"
#include "problem/triangles.glsl"
#include "geometry/solid.glsl"

// The point of a triangle that is nearest to p, up to rounding. The result is a point of the triangle in any case, or
// NaN if the triangle is degenerate and the device takes comparisons with NaN for true.
vec3 nearestOfTriangle(vec3 corners[3], vec3 p)
{
  const vec3 e1 = corners[1] - corners[0];
  const vec3 e2 = corners[2] - corners[0];
  const vec3 to = p - corners[0];
  const float d11 = dot(e1, e1);
  const float d12 = dot(e1, e2);
  const float d22 = dot(e2, e2);
  const float t1 = dot(e1, to);
  const float t2 = dot(e2, to);
  const float area = d11 * d22 - d12 * d12;
  // The nearest point of the triangle's plane counts if it is within the triangle. Otherwise the nearest point of the
  // edges counts.
  const float s = (d22 * t1 - d12 * t2) / area;
  const float t = (d11 * t2 - d12 * t1) / area;
  const bool within = s >= 0.0 && t >= 0.0 && s + t <= 1.0;
  const float on_first = d11 > 0.0 ? clamp(t1 / d11, 0.0, 1.0) : 0.0;
  const float on_second = d22 > 0.0 ? clamp(t2 / d22, 0.0, 1.0) : 0.0;
  const float d33 = d11 - 2.0 * d12 + d22;
  const float on_third = d33 > 0.0 ? clamp((t2 - t1 + d11 - d12) / d33, 0.0, 1.0) : 0.0;
  const vec3 a = corners[0] + on_first * e1;
  const vec3 b = corners[0] + on_second * e2;
  const vec3 c = corners[1] + on_third * (e2 - e1);
  const float da = dot(p - a, p - a);
  const float db = dot(p - b, p - b);
  const float dc = dot(p - c, p - c);
  const vec3 on_edge = da <= db && da <= dc ? a : (db <= dc ? b : c);
  return within ? corners[0] + s * e1 + t * e2 : on_edge;
}

// Returns true if all corners lie on one side of the solid along n, beyond it by more than `beyond` (for n of length
// 1).
bool liesBeyond(vec3 corners[3], Instance solid, vec3 n, float beyond)
{
  const vec3 heights = vec3(dot(n, corners[0]), dot(n, corners[1]), dot(n, corners[2]));
  const float least = min(heights.x, min(heights.y, heights.z));
  const float most = max(heights.x, max(heights.y, heights.z));
  const bool above = least > -most;
  return provenGreater(max(least, -most) - extentAlong(solid, above ? n : -n),
                       beyond * lengthAtMost(n) * (1.0 + 16.0 * u) + TINY);
}

// Tests a triangle against a solid. The corners, in the frame of the solid, are off by at most `error`. Returns
// STATE_HIT if the distance is proven to be at most `distance`, 0 if it is proven to be more than `gap`, else
// STATE_UNDECIDED.
// Apart: an axis beyond which all corners lie. The first axes are those that separate a triangle from a box (T.
// Akenine-Moeller: Fast 3D triangle-box overlap testing, 2001). The other axes are the lines between the two points of
// each step of the search for a hit.
// Hit: von Neumann's alternating projections between the triangle and a core of the solid, which lies a depth below the
// surface. A point of the triangle is inside the solid if its distance from the core is less than that depth. The depth
// shrinks from step to step. Two of three steps are extended to the plane that touches the core at its nearest point.
// A step that proves nothing leaves the result undecided, so the convergence of the search does not affect correctness.
uint triangleSolid(vec3 corners[3], Instance solid, float error, float distance, float gap)
{
  float size = dot(solid.size, solid.size);
  for (int i = 0; i < 3; ++i)
    size = max(size, dot(corners[i], corners[i]));
  const float off = error + 64.0 * u * sqrt(size);
  const float beyond = gap + off;
  const vec3 e1 = vectorBetween(corners[0], corners[1]);
  const vec3 e2 = vectorBetween(corners[0], corners[2]);
  precise const vec3 normal = cross(e1, e2);
  bool apart = liesBeyond(corners, solid, normal, beyond);
  for (int i = 0; i < 3; ++i)
  {
    const vec3 edge = vectorBetween(corners[i], corners[(i + 1) % 3]);
    apart = apart || liesBeyond(corners, solid, vec3(0.0, edge.z, -edge.y), beyond) ||
            liesBeyond(corners, solid, vec3(-edge.z, 0.0, edge.x), beyond) ||
            liesBeyond(corners, solid, vec3(edge.y, -edge.x, 0.0), beyond);
  }

  const float inner = innerRadius(solid);
  const float least = min(4.0 * off, 0.5 * inner);
  float depth = max(least, 0.25 * inner);
  vec3 p = nearestOfTriangle(corners, vec3(0.0));
  uint found = apart ? 0u : STATE_UNDECIDED;
  for (uint step = 0u; step < SOLID_ITERATIONS && found == STATE_UNDECIDED; ++step)
  {
    const vec3 q = projectToCore(solid.kind, coreSize(solid, depth), p);
    const vec3 n = vectorBetween(q, p);
    const float span = length(n);
    const vec3 next = nearestOfTriangle(corners, q);
    if (liesBeyond(corners, solid, n, beyond) || liesBeyond(corners, solid, vectorBetween(q, next), beyond))
      found = 0u;
    if (provenGreater(depth + distance * (1.0 - 4.0 * u), span + off))
      found = STATE_HIT;
    const float gain = dot(n, p - next);
    const float stretch = step % 3u != 2u && gain > 0.0 ? min(span * span / gain, 1e4) : 1.0;
    p = nearestOfTriangle(corners, p + stretch * (next - p));
    depth = max(least, 0.25 * depth);
  }
  return found;
}

// Tests triangle `i` of one leaf against the solid for which the other leaf stands.
void testSolidRow(uvec4 pair, uint i)
{
  const RootPair root_pair = fetchRootPair(pair.x);
  const bool a_is_solid = isSolidLeaf(pair.y);
  const Instance solid = fetchInstance(leafFirst(a_is_solid ? pair.y : pair.z) & ~SOLID_LEAF);
  vec3 corners[3];
  fetchTriangle(leafFirst(a_is_solid ? pair.z : pair.y) + i, corners);
  const float far = max(length(corners[0]), max(length(corners[1]), length(corners[2])));
  for (int k = 0; k < 3; ++k)
    corners[k] = a_is_solid ? apply(root_pair.pose, corners[k])
                            : (corners[k] - root_pair.pose.translation) * root_pair.pose.rotation;
  const float error = a_is_solid ? root_pair.error : inverseError(root_pair.error, vec3(far, 0.0, 0.0));
  const uint found = FLOAT32_TRUSTED != 0 ? triangleSolid(corners, solid, error, fetchDistance(pair.x), root_pair.gap)
                                          : STATE_UNDECIDED;
  if (found != 0u)
    report(root_pair.state, root_pair.pair, found);
}
