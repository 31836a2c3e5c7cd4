// Whether a shape has a part inside a solid without touching its surface: one point of each of its connected components
// tells, as long as no surfaces meet, which the traversal finds.
layout(std430, binding = BINDING_IN) readonly buffer ComponentPoints { vec4 component_points[]; };

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

// STATE_HIT if a point of `inner`, placed by `pose` in the solid's frame, is inside by more than `error`;
// STATE_UNDECIDED if one is within the error, or if there are too many components to look at; else 0.
uint containment(Instance inner, Instance solid, Pose pose, float error)
{
  if (solid.kind == SOLID_NONE)
    return 0u;
  if (inner.point_count == 0u)
    return STATE_UNDECIDED;
  float depth = -3.4e38;
  for (uint i = 0u; i < inner.point_count; ++i)
    depth = max(depth, depthInSolid(solid, apply(pose, component_points[inner.first_point + i].xyz)));
  return depth > error ? STATE_HIT : (depth > -error ? STATE_UNDECIDED : 0u);
}
