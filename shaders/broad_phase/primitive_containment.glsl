// Whether a shape has a part inside a primitive without touching its surface: one point of each of its connected components
// tells, as long as no surfaces meet, which the traversal finds.
#include "problem/components.glsl"

// How far a point is inside a solid, in metres; negative outside, and then no further than the true distance.
float depthInSolid(Instance solid, vec3 p)
{
  const vec3 size = solid.size;
  if (solid.kind == SOLID_BOX)
  {
    const vec3 depth = size - abs(p);
    return min(depth.x, min(depth.y, depth.z));
  }
  if (solid.kind == SOLID_SPHERE)
    return size.x - length(p);
  if (solid.kind == SOLID_CYLINDER)
    return min(size.x - length(p.xy), size.z - abs(p.z));
  // A cone's radius shrinks from size.x at the base, z = -size.z, to 0 at the apex; the distance is to its side.
  const float side = size.x * (size.z - p.z) / (2.0 * size.z) - length(p.xy);
  const float slope = 2.0 * size.z / sqrt(size.x * size.x + 4.0 * size.z * size.z);
  return min(side * slope, p.z + size.z);
}

// STATE_HIT if a point of `inner`, placed by `pose` in the primitive's frame, is inside by more than `error`;
// STATE_UNDECIDED if one is within the error, or if there are too many components to look at; else 0.
uint containment(Instance inner, Instance solid, Pose pose, float error)
{
  if (!isPrimitive(solid))
    return 0u;
  if (inner.component_count == 0u)
    return STATE_UNDECIDED;
  uint found = 0u;
  for (uint i = 0u; i < inner.component_count; ++i)
  {
    const float depth = depthInSolid(solid, apply(pose, componentPoint(inner.first_component + i)));
    found |= depth > error ? STATE_HIT : (depth < -error && FLOATS_DECIDE != 0 ? 0u : STATE_UNDECIDED);
  }
  return found;
}
