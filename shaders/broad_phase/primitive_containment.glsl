// Tests whether a part of a shape lies inside a primitive without touching its surface. One point of each connected
// component decides, provided that the surfaces do not meet. If they do, the traversal finds the collision. Own method:
// it follows from the definition of a connected component. Lengths are in metres.
#include "problem/components.glsl"

// The depth of a point below the surface of a solid. It is negative outside, where its absolute value is at most the
// true distance.
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
  // The radius of a cone shrinks from size.x at its base (z = -size.z) to 0 at its apex. side * slope is the depth
  // below the side of the cone.
  const float side = size.x * (size.z - p.z) / (2.0 * size.z) - length(p.xy);
  const float slope = 2.0 * size.z / sqrt(size.x * size.x + 4.0 * size.z * size.z);
  return min(side * slope, p.z + size.z);
}

// Returns STATE_* bits: STATE_HIT if a point of `inner` is inside the primitive by more than `error`, STATE_UNDECIDED
// if a point is within `error` of its surface or if `inner` has too many components. `pose` places `inner` in the frame
// of the primitive.
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
    found |= depth > error ? STATE_HIT : (depth < -error && FLOAT32_TRUSTED != 0 ? 0u : STATE_UNDECIDED);
  }
  return found;
}
