// The bounding volumes of the traversals: nodes with oriented bounding boxes (OBB), and the test whether two of them
// overlap. They have the order of the axis-aligned nodes. Lengths are in metres.
#include "geometry/quaternion.glsl"

struct OrientedNode
{
  Box box;     // centre in the frame of the tree, extent along `axes`
  mat3 axes;   // columns: the axes of the box in the frame of the tree
  uint first;  // `first` and `count`: as in TreeNode
  uint count;
};

layout(binding = UNIT_ORIENTED_NODES) uniform usamplerBuffer oriented_texels;

OrientedNode fetchOrientedNode(uint index)
{
  const uvec4 a = texelFetch(oriented_texels, int(ORIENTED_NODE_TEXELS * index));
  const uvec4 b = texelFetch(oriented_texels, int(ORIENTED_NODE_TEXELS * index + 1u));
  const vec4 q = uintBitsToFloat(texelFetch(oriented_texels, int(ORIENTED_NODE_TEXELS * index + 2u)));
  return OrientedNode(Box(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz)), rotationOf(q), a.w, b.w);
}

// The largest gap between two boxes along the 15 axes that can separate them (Gottschalk, Lin and Manocha 1996,
// "OBBTree"). A gap that is not above 0 proves nothing. In: the half edge lengths of both boxes; t, the vector from a's
// centre to b's; r, the axes of b; t and r are given along the axes of a. The axes that are products of edges are at
// most 1 long, so the gap along them in metres is at least the computed one.
float boxGap(vec3 ea, vec3 eb, vec3 t, mat3 r)
{
  const mat3 q = absolute(r);
  const vec3 gap_a = abs(t) - (ea + q * eb);
  const vec3 gap_b = abs(t * r) - (eb + ea * q);
  float gap = max(max(max(gap_a.x, gap_a.y), gap_a.z), max(max(gap_b.x, gap_b.y), gap_b.z));
  // The cross products of the axes x, y, z of a with axis j of b, three at a time.
  for (int j = 0; j < 3; ++j)
  {
    const int k = (j + 1) % 3;
    const int l = (j + 2) % 3;
    const vec3 along = abs(t.zxy * r[j].yzx - t.yzx * r[j].zxy);
    const vec3 reach_a = ea.yzx * q[j].zxy + ea.zxy * q[j].yzx;
    const vec3 reach_b = eb[k] * q[l] + eb[l] * q[k];
    const vec3 gaps = along - (reach_a + reach_b);
    gap = max(gap, max(max(gaps.x, gaps.y), gaps.z));
  }
  return gap;
}

// The part of the error of a test of two boxes that grows with their half edge lengths.
float sizeError(Box a, Box b)
{
  return 512.0 * u * dot(a.extent + b.extent, vec3(1.0));
}

// Returns true if the line of the centres is an axis along which two boxes are proven to be more than `needed` apart.
// None of the 15 axes may point from one box to the other. If the required distance is long against the boxes, this
// axis then separates more boxes. Own method.
bool apartAlongCenters(OrientedNode a, OrientedNode b, Pose pose, float needed)
{
  const vec3 n = vectorBetween(a.box.center, apply(pose, b.box.center));
  const float reach = dot(abs(n * a.axes), a.box.extent) + dot(abs(n * pose.rotation * b.axes), b.box.extent);
  return dot(n, n) - reach > needed * lengthAtMost(n) * (1.0 + 16.0 * u);
}

// Returns true if node b is proven to be more than `gap` apart from node a. `pose` places the tree of b in the frame of
// the tree of a, with the position error `error`. False proves nothing.
bool nodesApart(OrientedNode a, OrientedNode b, Pose pose, float gap, float error)
{
  const vec3 between = (apply(pose, b.box.center) - a.box.center) * a.axes;
  const mat3 turned = transpose(a.axes) * (pose.rotation * b.axes);
  const float size_error = sizeError(a.box, b.box);
  const bool apart = boxGap(a.box.extent, b.box.extent, between, turned) > boxMargin(gap, error) + size_error;
#if PADDED
  return apart || apartAlongCenters(a, b, pose, centersMargin(gap, error) + size_error);
#else
  return apart;
#endif
}

// Returns true if the box of a node lies within the core of the other tree's solid, by more than `margin`. The contents
// of the node are then inside that solid. A shape without a core has negative extents, which contain nothing.
bool nodeInCore(OrientedNode a, OrientedNode b, vec3 core_a, vec3 core_b, Pose pose, float margin)
{
  const mat3 b_axes = pose.rotation * b.axes;
  const mat3 a_axes = transpose(pose.rotation) * a.axes;
  const float off = margin + sizeError(a.box, b.box);
  const vec3 b_in_a = abs(apply(pose, b.box.center)) + absolute(b_axes) * b.box.extent + off;
  const vec3 a_in_b = abs((a.box.center - pose.translation) * pose.rotation) + absolute(a_axes) * a.box.extent + off;
  return all(lessThan(b_in_a, core_a)) || all(lessThan(a_in_b, core_b));
}

// Chooses which of two overlapping nodes the traversal opens: an inner node rather than a leaf, and the larger one of
// two inner nodes. Returns true for node a.
bool descendsIntoA(OrientedNode a, OrientedNode b)
{
  return a.count == 0u && (b.count != 0u || dot(a.box.extent, a.box.extent) >= dot(b.box.extent, b.box.extent));
}
