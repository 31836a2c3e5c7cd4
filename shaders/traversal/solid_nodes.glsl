// Tests nodes against solids, in the programs for solids. These tests separate more pairs than tests of two boxes,
// because the box around a curved solid has corners that the solid does not fill. They are separating axis tests with
// one axis. The choice of this axis is our own. Lengths are in metres.
#include "common/comparisons.glsl"
#include "geometry/pose.glsl"
#include "geometry/solid.glsl"

// Returns true if a box is proven to lie beyond the solid by more than `margin`. The axis is the line from the nearest
// point of the solid to the centre of the box. The centre and the axes of the box are in the frame of the solid. False
// proves nothing.
bool boxBeyondSolid(Instance solid, vec3 center, mat3 axes, vec3 extent, float margin)
{
  const vec3 n = vectorBetween(projectToCore(solid.kind, coreSize(solid, 0.0), center), center);
  const float gap = dot(n, center) - dot(abs(n * axes), extent) - extentAlong(solid, n);
  return provenGreater(gap, margin * lengthAtMost(n) * (1.0 + 16.0 * u) + TINY);
}

// The same test for two nodes, one of which stands for a solid: node a if its instance is a primitive, otherwise node b
// (broad_phase/root_pairs.comp).
bool nodeBeyondSolid(OrientedNode a, OrientedNode b, Instance instance_a, Instance instance_b, RootPair root_pair)
{
  const float margin = boxMargin(root_pair.gap, root_pair.error) + sizeError(a.box, b.box);
  if (isPrimitive(instance_a))
    return boxBeyondSolid(instance_a, apply(root_pair.pose, b.box.center), root_pair.pose.rotation * b.axes,
                          b.box.extent, margin);
  const float inverse = inverseError(0.0, abs(a.box.center) + dot(a.box.extent, vec3(1.0)));
  return boxBeyondSolid(instance_b, (a.box.center - root_pair.pose.translation) * root_pair.pose.rotation,
                        transpose(root_pair.pose.rotation) * a.axes, a.box.extent, margin + inverse);
}
