// Nodes against solids, in the programs for these. The boxes around curved solids have corners that the solids do not fill.
#include "geometry/solid.glsl"

// Whether a box with its centre and axes in the solid's frame lies beyond the solid by more than `margin`, along the line from
// the point of the solid that is nearest to the centre. `false` proves nothing.
bool boxBeyondSolid(Instance solid, vec3 center, mat3 axes, vec3 extent, float margin)
{
  const vec3 n = center - projectToCore(solid.kind, coreSize(solid, 0.0), center);
  const float gap = dot(n, center) - dot(abs(n * axes), extent) - extentAlong(solid, n);
  return gap > margin * lengthAtMost(n) * (1.0 + 16.0 * u) + TINY;
}

// The same for nodes of which one stands for a solid: a's where that is a primitive, else b's (check_roots.comp).
bool nodeBeyondSolid(OrientedNode a, OrientedNode b, Instance instance_a, Instance instance_b, RootPair root_pair)
{
  const float margin = boxMargin(root_pair.gap, root_pair.error) + sizeError(a.box, b.box);
  if (isPrimitive(instance_a))
    return boxBeyondSolid(instance_a, apply(root_pair.pose, b.box.center), root_pair.pose.rotation * b.axes, b.box.extent, margin);
  const float inverse = inverseError(0.0, abs(a.box.center) + dot(a.box.extent, vec3(1.0)));
  return boxBeyondSolid(instance_b, (a.box.center - root_pair.pose.translation) * root_pair.pose.rotation,
                        transpose(root_pair.pose.rotation) * a.axes, a.box.extent, margin + inverse);
}
